// Our sequence files in the hands of VTK's MetaImage reader, and beside the files that PLUS itself wrote.
#include <gtest/gtest.h>
#include <vtkImageData.h>
#include <vtkMetaImageReader.h>
#include <vtkNew.h>

#include <fstream>
#include <regex>
#include <set>

#include "acquire/record/recorder.hpp"
#include "tests/support/child_process.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/unit/record/sample_data.hpp"
#include "tools/export/export_recording.hpp"

namespace linescope {
namespace {

void record(const std::filesystem::path& folder) {
  RecorderOptions options;
  options.folder = folder;
  options.keep_free = 0;
  auto recorder = Recorder::start(options, testing::made_info());
  ASSERT_TRUE(recorder) << recorder.error().message;
  for (std::uint64_t i = 0; i < 5; ++i) (*recorder)->add(testing::made_frame(i, 20, 10));
  for (std::uint32_t i = 0; i < 60; ++i) (*recorder)->add(testing::made_sample(i));
  (*recorder)->stop();
}

TEST(ExportForeign, VtkReadsSizeChannelsAndPixels) {
  const testing::TemporaryFolder folder;
  record(folder / "scan");
  ASSERT_TRUE(export_pictures_sequence(folder / "scan", folder / "out.mha"));
  vtkNew<vtkMetaImageReader> reader;
  reader->SetFileName((folder / "out.mha").c_str());
  ASSERT_TRUE(reader->CanReadFile(reader->GetFileName()));
  reader->Update();
  vtkImageData* image = reader->GetOutput();
  ASSERT_EQ(image->GetDimensions()[0], 20);
  ASSERT_EQ(image->GetDimensions()[1], 10);
  ASSERT_EQ(image->GetDimensions()[2], 5);
  ASSERT_EQ(image->GetNumberOfScalarComponents(), 3);
  for (int z = 0; z < 5; ++z) {
    const Frame frame = testing::made_frame(static_cast<std::uint64_t>(z), 20, 10);
    for (int y = 0; y < 10; ++y) {
      for (int x = 0; x < 20; ++x) {
        const auto* rgb = static_cast<const unsigned char*>(image->GetScalarPointer(x, y, z));
        const cv::Vec3b bgr = frame.bgr.at<cv::Vec3b>(y, x);
        ASSERT_EQ(cv::Vec3b(rgb[2], rgb[1], rgb[0]), bgr) << x << ' ' << y << ' ' << z;
      }
    }
  }
}

/// Names of the header's fields; frame numbers and tool names are taken out.
std::set<std::string> field_names(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::set<std::string> names;
  for (std::string line; std::getline(stream, line);) {
    const auto equals = line.find(" = ");
    if (equals == std::string::npos) continue;
    std::string field = std::regex_replace(line.substr(0, equals), std::regex("Seq_Frame[0-9]+_"), "Seq_");
    names.insert(std::regex_replace(field, std::regex("Seq_[A-Za-z]+To[A-Za-z]+Transform"), "Seq_Transform"));
    if (line.rfind("ElementDataFile", 0) == 0) break;
  }
  return names;
}

TEST(ExportForeign, FieldsAreThoseOfPlus) {
  LINESCOPE_NEEDS_SHARED_DATA();
  const testing::TemporaryFolder folder;
  record(folder / "scan");
  ASSERT_TRUE(export_tracker_sequence(folder / "scan", folder / "out.igs.mha"));
  const auto ours = field_names(folder / "out.igs.mha");
  auto theirs = field_names(testing::shared_data("tracker/TransformInterpolationTest.igs.mha"));
  theirs.erase("CompressedDataSize");  // only of compressed files
  theirs.erase("Seq_Stylus");          // a field of that recording's own
  for (const std::string& field : theirs) EXPECT_TRUE(ours.contains(field)) << field << " is missing";
}

}  // namespace
}  // namespace linescope
