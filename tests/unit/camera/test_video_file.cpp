#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>
#include <vector>

#include "acquire/camera/video_file.hpp"
#include "tests/support/child_process.hpp"

namespace linescope {
namespace {

using ::testing::HasSubstr;

class Video : public ::testing::Test {
 protected:
  /// FFV1 keeps BGR only through its RGB mode; grey pictures survive its YUV mode to the bit as well.
  std::vector<cv::Mat> write(const std::string& name, int count, double rate) const {
    cv::VideoWriter writer((folder / name).string(), cv::CAP_FFMPEG,
                           cv::VideoWriter::fourcc('F', 'F', 'V', '1'), rate, cv::Size(64, 48));
    EXPECT_TRUE(writer.isOpened());
    std::vector<cv::Mat> pictures;
    for (int i = 0; i < count; ++i) {
      pictures.emplace_back(48, 64, CV_8UC3, cv::Scalar::all(20 + 7 * i));
      writer.write(pictures.back());
    }
    return pictures;
  }

  testing::TemporaryFolder folder;
  Frame frame;
};

TEST_F(Video, GivesAllPicturesWithTheTimesOfTheFile) {
  const auto pictures = write("scan.mkv", 10, 25);
  VideoFile source({.file = folder / "scan.mkv", .start_time = 3 * kSecond});
  ASSERT_TRUE(source.start());
  EXPECT_EQ(source.period(), 40 * kMillisecond);
  for (std::uint64_t i = 0; i < pictures.size(); ++i) {
    ASSERT_EQ(source.next(frame).value(), Pull::item) << i;
    EXPECT_EQ(frame.index, i);
    EXPECT_EQ(frame.time, 3 * kSecond + static_cast<Nanoseconds>(i) * 40 * kMillisecond);
    EXPECT_LE(cv::norm(frame.bgr, pictures[i], cv::NORM_INF), 1) << "YUV rounding";
  }
  EXPECT_EQ(source.next(frame).value(), Pull::end);
  EXPECT_EQ(source.next(frame).value(), Pull::end);
  EXPECT_EQ(source.status().reason, "all 10 pictures were read");
}

TEST_F(Video, AskedPeriodReplacesTheTimesOfTheFile) {
  write("scan.mkv", 3, 25);
  VideoFile source({.file = folder / "scan.mkv", .period = 33'333'333});
  ASSERT_TRUE(source.start());
  for (int i = 0; i < 3; ++i) ASSERT_EQ(source.next(frame).value(), Pull::item);
  EXPECT_EQ(frame.time, 2 * 33'333'333);
}

TEST_F(Video, OtherSizeThanAskedIsAMismatch) {
  write("scan.mkv", 2, 25);
  VideoFile source({.file = folder / "scan.mkv", .width = 640, .height = 480});
  ASSERT_TRUE(source.start());
  EXPECT_EQ(source.next(frame).error().code, ErrorCode::mismatch);
  EXPECT_EQ(source.next(frame).error().code, ErrorCode::mismatch);
  EXPECT_EQ(source.next(frame).value(), Pull::end);
  EXPECT_EQ(source.status().counters.mismatched, 2U);
}

TEST_F(Video, CutFileGivesItsGoodPartAndSaysSo) {
  cv::VideoWriter writer((folder / "scan.avi").string(), cv::CAP_FFMPEG,
                         cv::VideoWriter::fourcc('F', 'F', 'V', '1'), 25, cv::Size(64, 48));
  cv::Mat noise(48, 64, CV_8UC3);
  for (int i = 0; i < 40; ++i) {
    cv::randu(noise, 0, 256);
    writer.write(noise);
  }
  writer.release();
  const auto size = std::filesystem::file_size(folder / "scan.avi");
  std::filesystem::resize_file(folder / "scan.avi", size / 2);
  VideoFile source({.file = folder / "scan.avi"});
  ASSERT_TRUE(source.start());
  int good = 0;
  for (auto pull = source.next(frame); !pull || *pull != Pull::end; pull = source.next(frame))
    good += pull ? 1 : 0;
  EXPECT_GT(good, 10);
  EXPECT_LT(good, 40);
  EXPECT_THAT(source.status().reason, HasSubstr("it is damaged or cut off"));
}

TEST_F(Video, MissingFileAndOtherFilesAreSentences) {
  EXPECT_EQ(VideoFile({.file = folder / "none.mkv"}).start().error().message,
            "there is no video file " + (folder / "none.mkv").string() + "; check the path");
  std::ofstream(folder / "text.mkv") << "no video";
  const auto broken = VideoFile({.file = folder / "text.mkv"}).start();
  EXPECT_EQ(broken.error().code, ErrorCode::unreadable);
  EXPECT_THAT(broken.error().message, HasSubstr("cannot be read as a video"));
}

TEST_F(Video, ImpossibleOptionsAreRefused) {
  EXPECT_EQ(validate(VideoFileOptions{}).error().code, ErrorCode::usage);
  EXPECT_EQ(validate(VideoFileOptions{.file = "x", .period = -1}).error().code, ErrorCode::invalid);
  EXPECT_EQ(validate(VideoFileOptions{.file = "x", .height = 480}).error().code, ErrorCode::invalid);
}

}  // namespace
}  // namespace linescope
