#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "acquire/camera/picture_folder.hpp"
#include "tests/support/child_process.hpp"

namespace linescope {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

class Folder : public ::testing::Test {
 protected:
  static cv::Mat noise(int width = 32, int height = 24) {
    cv::Mat picture(height, width, CV_8UC3);
    cv::randu(picture, 0, 256);
    return picture;
  }
  cv::Mat write(const std::string& name, const cv::Mat& picture) const {
    EXPECT_TRUE(cv::imwrite((folder / name).string(), picture));
    return picture;
  }
  void cut(const std::string& name, double fraction) const {
    const auto file = folder / name;
    const auto size = static_cast<double>(std::filesystem::file_size(file));
    std::filesystem::resize_file(file, static_cast<std::uintmax_t>(size * fraction));
  }
  PictureFolder started(PictureFolderOptions options = {}) const {
    options.folder = folder.path();
    PictureFolder source(options);
    const auto result = source.start();
    EXPECT_TRUE(result) << result.error().message;
    return source;
  }

  testing::TemporaryFolder folder;
  Frame frame;
};

TEST_F(Folder, GivesPicturesInNaturalOrderWithMadeUpTimes) {
  for (const char* name : {"im0.png", "im10.png", "im2.png"}) write(name, noise());
  PictureFolder source = started({.start_time = 5 * kSecond, .period = 20 * kMillisecond});
  const std::vector<std::string> names{"im0.png", "im2.png", "im10.png"};
  for (std::uint64_t i = 0; i < names.size(); ++i) {
    ASSERT_EQ(source.next(frame).value(), Pull::item);
    EXPECT_EQ(frame.name, names[i]);
    EXPECT_EQ(frame.index, i);
    EXPECT_EQ(frame.time, 5 * kSecond + static_cast<Nanoseconds>(i) * 20 * kMillisecond);
  }
  EXPECT_EQ(source.next(frame).value(), Pull::end);
  EXPECT_EQ(source.next(frame).value(), Pull::end) << "the end is for ever";
  EXPECT_EQ(source.status().state, CameraState::ended);
  EXPECT_EQ(source.status().counters.delivered, 3U);
}

TEST_F(Folder, PixelsAreThoseOfTheFile) {
  const cv::Mat written = write("a.png", noise());
  PictureFolder source = started();
  ASSERT_EQ(source.next(frame).value(), Pull::item);
  EXPECT_EQ(cv::norm(frame.bgr, written, cv::NORM_INF), 0);
}

TEST_F(Folder, GreyPicturesBecomeThreeChannels) {
  cv::Mat grey(10, 12, CV_8UC1, cv::Scalar(77));
  write("a.png", grey);
  PictureFolder source = started();
  ASSERT_EQ(source.next(frame).value(), Pull::item);
  EXPECT_EQ(frame.bgr.type(), CV_8UC3);
  EXPECT_EQ(frame.bgr.at<cv::Vec3b>(5, 5), cv::Vec3b(77, 77, 77));
}

TEST_F(Folder, ListedPicturesAreTheOnesGiven) {
  for (const char* name : {"b1.jpg", "b11.jpg", "b3.jpg", "notes.txt"})
    write(std::string(name) == "notes.txt" ? "b2.bmp" : name, noise());
  std::ofstream(folder / "poses.csv") << "frame\n";
  const auto listed = list_pictures({.folder = folder.path(), .start_time = 7, .period = 10});
  ASSERT_TRUE(listed);
  PictureFolder source = started({.start_time = 7, .period = 10});
  ASSERT_THAT(*listed, SizeIs(4));
  for (const TimedPicture& entry : *listed) {
    ASSERT_EQ(source.next(frame).value(), Pull::item);
    EXPECT_EQ(frame.name, entry.name);
    EXPECT_EQ(frame.time, entry.time);
  }
}

class BrokenPicture : public Folder, public ::testing::WithParamInterface<std::tuple<const char*, double>> {};

TEST_P(BrokenPicture, ConcernsThatPictureOnlyAndIsCounted) {
  const auto [ending, kept] = GetParam();
  for (const char* stem : {"im0", "im1", "im2"}) write(std::string(stem) + ending, noise(64, 64));
  const std::string broken = std::string("im1") + ending;
  cut(broken, kept);
  PictureFolder source = started();
  ASSERT_EQ(source.next(frame).value(), Pull::item);
  const auto bad = source.next(frame);
  ASSERT_FALSE(bad) << "a part of a picture was taken for a whole one";
  EXPECT_EQ(bad.error().code, ErrorCode::unreadable);
  EXPECT_THAT(bad.error().message, HasSubstr(broken));
  ASSERT_EQ(source.next(frame).value(), Pull::item);
  EXPECT_EQ(frame.index, 2U) << "the broken picture keeps its place and its time";
  EXPECT_EQ(source.next(frame).value(), Pull::end);
  EXPECT_EQ(source.status().counters.unreadable, 1U);
  EXPECT_EQ(source.status().counters.delivered, 2U);
}

INSTANTIATE_TEST_SUITE_P(Cut, BrokenPicture,
                         ::testing::Combine(::testing::Values(".png", ".jpg", ".bmp", ".tif", ".ppm"),
                                            ::testing::Values(0.0, 0.02, 0.5, 0.98)));

TEST_F(Folder, FileThatIsNoPictureIsUnreadable) {
  std::ofstream(folder / "im0.png") << "this is not a picture";
  write("im1.png", noise());
  PictureFolder source = started();
  EXPECT_EQ(source.next(frame).error().code, ErrorCode::unreadable);
  EXPECT_EQ(source.next(frame).value(), Pull::item);
}

TEST_F(Folder, PictureRemovedMeanwhileIsUnreadable) {
  write("im0.png", noise());
  write("im1.png", noise());
  PictureFolder source = started();
  std::filesystem::remove(folder / "im0.png");
  EXPECT_EQ(source.next(frame).error().code, ErrorCode::unreadable);
  EXPECT_EQ(source.next(frame).value(), Pull::item);
}

TEST_F(Folder, OtherSizeThanTheFirstIsAMismatchOfThatPicture) {
  write("im0.png", noise(32, 24));
  write("im1.png", noise(24, 32));
  write("im2.png", noise(32, 24));
  PictureFolder source = started();
  ASSERT_EQ(source.next(frame).value(), Pull::item);
  const auto bad = source.next(frame);
  ASSERT_FALSE(bad);
  EXPECT_EQ(bad.error().code, ErrorCode::mismatch);
  EXPECT_EQ(bad.error().message, "picture im1.png is 24x32 px where 32x24 px is expected; it is passed over");
  EXPECT_EQ(source.next(frame).value(), Pull::item);
  EXPECT_EQ(source.status().counters.mismatched, 1U);
}

TEST_F(Folder, OtherSizeThanAskedIsAMismatchFromTheFirst) {
  write("im0.png", noise(32, 24));
  PictureFolder source = started({.width = 640, .height = 480});
  EXPECT_EQ(source.next(frame).error().code, ErrorCode::mismatch);
}

TEST_F(Folder, MissingFolderEmptyFolderAndFileAreSentences) {
  const auto missing = list_pictures({.folder = folder / "none"});
  EXPECT_EQ(missing.error().code, ErrorCode::not_found);
  EXPECT_THAT(missing.error().message, HasSubstr("there is no folder " + (folder / "none").string()));
  const auto empty = list_pictures({.folder = folder.path()});
  EXPECT_EQ(empty.error().code, ErrorCode::not_found);
  EXPECT_THAT(empty.error().message, HasSubstr("holds no pictures"));
  write("a.png", noise());
  EXPECT_THAT(list_pictures({.folder = folder / "a.png"}).error().message, HasSubstr("is not a folder"));
}

TEST_F(Folder, ImpossibleOptionsAreRefused) {
  EXPECT_EQ(validate(PictureFolderOptions{}).error().code, ErrorCode::usage);
  EXPECT_EQ(validate(PictureFolderOptions{.folder = "x", .period = 0}).error().code, ErrorCode::invalid);
  EXPECT_EQ(validate(PictureFolderOptions{.folder = "x", .width = 640}).error().code, ErrorCode::invalid);
}

TEST_F(Folder, NextBeforeStartIsAMistakeOfTheCaller) {
  PictureFolder source({.folder = folder.path()});
  EXPECT_EQ(source.next(frame).error().code, ErrorCode::usage);
}

}  // namespace
}  // namespace linescope
