// The twin and the product must not share code that projects, refracts or triangulates: a common error would
// cancel out, and every figure of the evaluation would be worth nothing. Checked in what is linked and in
// what is written.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace linescope::twin {
namespace {

std::string output_of(const std::string& command) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::string text;
  std::array<char, 4096> buffer{};
  while (pipe && std::fgets(buffer.data(), static_cast<int>(buffer.size()), pipe.get()))
    text += buffer.data();
  return text;
}

std::string undefined_symbols() {
  return output_of(
      fmt::format("{} --undefined-only --demangle '{}' 2>/dev/null", LINESCOPE_NM, LINESCOPE_TWIN_LIBRARY));
}

const std::array kForbiddenSymbols{"CameraModel::",    "LineReconstructor", "RayTable::undistort",
                                   "laser_plane_from", "opencv_from_laser", "baseline_form",
                                   "cv::undistort",    "cv::projectPoints", "cv::initUndistort",
                                   "cv::Rodrigues",    "cv::triangulate",   "cv::solvePnP"};

TEST(TwinIsSeparate, LinksNothingThatProjectsOrTriangulates) {
  const std::string symbols = undefined_symbols();
  ASSERT_NE(symbols.find("linescope::euler_from_quaternion"), std::string::npos) << "nm found no symbols";
  for (const char* forbidden : kForbiddenSymbols) {
    EXPECT_EQ(symbols.find(forbidden), std::string::npos) << forbidden;
  }
}

/// Functions a library defines or calls, without those the standard library makes of templates.
std::set<std::string> functions_of(const char* library) {
  std::istringstream lines(output_of(fmt::format("{} --demangle '{}' 2>/dev/null", LINESCOPE_NM, library)));
  std::set<std::string> names;
  for (std::string line; std::getline(lines, line);) {
    const auto name = line.size() > 19 ? line.substr(19) : std::string();
    if (name.rfind("linescope::", 0) == 0 && name.find('(') != std::string::npos) names.insert(name);
  }
  return names;
}

std::vector<std::string> shared_functions() {
  const auto twin = functions_of(LINESCOPE_TWIN_LIBRARY);
  const auto product = functions_of(LINESCOPE_RECONSTRUCT_LIBRARY);
  EXPECT_FALSE(twin.empty() || product.empty()) << "nm found no symbols";
  std::vector<std::string> shared;
  std::set_intersection(twin.begin(), twin.end(), product.begin(), product.end(), std::back_inserter(shared));
  return shared;
}

// Not only the names we think of: whatever function of ours both call or contain, it is nothing but the
// composition of rigid transforms.
TEST(TwinIsSeparate, SharesNoFunctionOfOursWithReconstructionButRigidTransforms) {
  for (const std::string& name : shared_functions())
    EXPECT_EQ(name.rfind("linescope::Rigid<", 0), 0u) << name;
}

std::vector<std::filesystem::path> sources() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(LINESCOPE_TWIN_SOURCES)) {
    const auto extension = entry.path().extension();
    if (extension == ".cpp" || extension == ".hpp") files.push_back(entry.path());
  }
  return files;
}

const std::array kForbiddenNames{"acquire/reconstruct",
                                 "acquire/laser/",
                                 "camera_convention",
                                 "normalised_from_pixel",
                                 "pixel_from_normalised",
                                 "depth_along",
                                 ".project(",
                                 "projectPoints",
                                 "undistort(",
                                 "undistortPoints(",
                                 "calib3d",
                                 "scaled_to",
                                 "thesis_camera"};

// Inline functions leave no symbol behind: the text itself must not name them.
TEST(TwinIsSeparate, SourcesNameNoneOfTheProductsGeometry) {
  const auto files = sources();
  ASSERT_GT(files.size(), 40u);
  for (const auto& file : files) {
    std::ifstream stream(file);
    std::stringstream text;
    text << stream.rdbuf();
    const std::string content = text.str();
    for (const char* name : kForbiddenNames)
      EXPECT_EQ(content.find(name), std::string::npos) << file.filename() << " names " << name;
  }
}

// And the other way round: the product must not measure with the twin's optics.
TEST(TwinIsSeparate, ReconstructionDoesNotIncludeTheTwin) {
  for (const char* folder : {"reconstruct", "laser"}) {
    for (const auto& entry :
         std::filesystem::directory_iterator(std::filesystem::path(LINESCOPE_TWIN_SOURCES) / ".." / folder)) {
      std::ifstream stream(entry.path());
      std::stringstream text;
      text << stream.rdbuf();
      EXPECT_EQ(text.str().find("acquire/twin"), std::string::npos) << entry.path();
    }
  }
}

}  // namespace
}  // namespace linescope::twin
