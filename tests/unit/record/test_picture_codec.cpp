#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "acquire/record/picture_codec.hpp"

namespace linescope {
namespace {

cv::Mat noise(int width, int height) {
  cv::Mat picture(height, width, CV_8UC3);
  cv::randu(picture, 0, 256);
  return picture;
}

bool survives(const cv::Mat& picture, PictureEncoding encoding) {
  PictureCodec codec;
  Bytes bytes;
  codec.encode(picture, encoding, bytes);
  cv::Mat back;
  return codec.decode(bytes, encoding, picture.cols, picture.rows, back) && back.size() == picture.size() &&
         cv::norm(back, picture, cv::NORM_INF) == 0;
}

class Encodings : public ::testing::TestWithParam<PictureEncoding> {};
INSTANTIATE_TEST_SUITE_P(Both, Encodings,
                         ::testing::Values(PictureEncoding::plain, PictureEncoding::row_zstd));

TEST_P(Encodings, LoseNothing) {
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 7}, {7, 1}, {64, 48}, {333, 217}}) {
    EXPECT_TRUE(survives(noise(width, height), GetParam())) << width << 'x' << height;
  }
  cv::Mat extremes(10, 10, CV_8UC3, cv::Scalar::all(0));
  for (int y = 1; y < 10; y += 2) extremes.row(y).setTo(cv::Scalar::all(255));
  EXPECT_TRUE(survives(extremes, GetParam())) << "differences that wrap around";
}

TEST_P(Encodings, PartOfALargerPictureIsTakenByItsRows) {
  const cv::Mat whole = noise(100, 80);
  EXPECT_TRUE(survives(whole(cv::Rect(13, 7, 31, 22)), GetParam()));
}

TEST_P(Encodings, DamagedBytesAreRefusedOrOfTheRightSize) {
  PictureCodec codec;
  const cv::Mat picture = noise(32, 24);
  Bytes bytes;
  codec.encode(picture, GetParam(), bytes);
  cv::Mat back;
  EXPECT_FALSE(codec.decode(std::span(bytes).first(bytes.size() / 2), GetParam(), 32, 24, back));
  EXPECT_FALSE(codec.decode(bytes, GetParam(), 32, 25, back)) << "other size than it was made from";
  EXPECT_FALSE(codec.decode({}, GetParam(), 32, 24, back));
  EXPECT_FALSE(codec.decode(bytes, static_cast<PictureEncoding>(77), 32, 24, back));
}

TEST(PictureCodec, AppendsBehindWhatIsThere) {
  PictureCodec codec;
  Bytes bytes{1, 2, 3};
  const cv::Mat picture = noise(16, 16);
  codec.encode(picture, PictureEncoding::row_zstd, bytes);
  EXPECT_EQ(bytes[1], 2);
  cv::Mat back;
  EXPECT_TRUE(codec.decode(std::span(bytes).subspan(3), PictureEncoding::row_zstd, 16, 16, back));
}

TEST(PictureCodec, SmoothPicturesBecomeSmall) {
  PictureCodec codec;
  cv::Mat smooth(240, 320, CV_8UC3);
  for (int y = 0; y < smooth.rows; ++y) smooth.row(y).setTo(cv::Scalar::all(y));
  Bytes bytes;
  codec.encode(smooth, PictureEncoding::row_zstd, bytes);
  EXPECT_LT(bytes.size(), smooth.total() * 3 / 100);
}

}  // namespace
}  // namespace linescope
