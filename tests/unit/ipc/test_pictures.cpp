// The latest picture with its line.
#include <numeric>

#include "tests/unit/ipc/segment_fixture.hpp"

namespace linescope::testing {
namespace {

class Pictures : public SegmentTest {
 protected:
  /// Every byte tells its place; rows are `stride` apart with bytes of another value in the gap.
  static std::vector<std::byte> pixels(std::size_t row_bytes, std::size_t rows, std::size_t stride) {
    std::vector<std::byte> p(stride * rows, std::byte{0xee});
    for (std::size_t y = 0; y < rows; ++y)
      for (std::size_t x = 0; x < row_bytes; ++x)
        p[y * stride + x] = static_cast<std::byte>((y * 31 + x) & 0x7f);
    return p;
  }
  void expect_pixels(std::size_t row_bytes, std::size_t rows) const {
    for (std::size_t y = 0; y < rows; ++y)
      for (std::size_t x = 0; x < row_bytes; ++x)
        ASSERT_EQ(picture_.pixels[y * picture_.stride + x], static_cast<std::byte>((y * 31 + x) & 0x7f))
            << y << ' ' << x;
  }
  Picture picture_;
};

TEST_F(Pictures, OddWidthsAndPaddedRowsComeBack) {
  for (const std::uint32_t width : {1U, 7U, 33U, 64U}) {
    const auto in = pixels(width * 3, 5, width * 3 + 13);
    const PictureInfo info{.time = 123,
                           .frame = width,
                           .width = width,
                           .height = 5,
                           .format = PixelFormat::bgr8,
                           .name = "frame_007.png"};
    ASSERT_TRUE(writer_->publish_picture(info, in.data(), width * 3 + 13, {}));
    ASSERT_EQ(reader_->picture(picture_), ReadOutcome::ok);
    EXPECT_EQ(picture_.width, width);
    EXPECT_EQ(picture_.height, 5U);
    EXPECT_EQ(picture_.frame, width);
    EXPECT_EQ(picture_.time, 123);
    EXPECT_EQ(picture_.name, "frame_007.png");
    EXPECT_EQ(picture_.stride % 8, 0U);
    expect_pixels(width * 3, 5);
  }
}

TEST_F(Pictures, GrayPicturesAndTheLineComeBack) {
  const auto in = pixels(20, 4, 20);
  const std::vector<PictureSample> line{{1, 2.5F, 200, 9}, {2, 2.75F, 201, 10}};
  ASSERT_TRUE(writer_->publish_picture({.width = 20, .height = 4, .format = PixelFormat::gray8}, in.data(),
                                       20, line));
  ASSERT_EQ(reader_->picture(picture_), ReadOutcome::ok);
  EXPECT_EQ(picture_.format, PixelFormat::gray8);
  expect_pixels(20, 4);
  ASSERT_EQ(picture_.samples.size(), 2U);
  EXPECT_EQ(picture_.samples[1].v, 2.75F);
  EXPECT_EQ(picture_.samples[1].peak, 201);
  EXPECT_EQ(picture_.samples[1].snr, 10);
}

TEST_F(Pictures, TheSamePictureIsNotGivenTwiceAndGapsAreVisible) {
  const auto in = pixels(8, 1, 8);
  const PictureInfo info{.width = 8, .height = 1, .format = PixelFormat::gray8};
  EXPECT_EQ(reader_->picture(picture_), ReadOutcome::nothing);
  writer_->publish_picture(info, in.data(), 8, {});
  ASSERT_EQ(reader_->picture(picture_), ReadOutcome::ok);
  EXPECT_EQ(picture_.number, 1U);
  EXPECT_EQ(reader_->picture(picture_), ReadOutcome::nothing);
  for (int i = 0; i < 5; ++i) writer_->publish_picture(info, in.data(), 8, {});
  ASSERT_EQ(reader_->picture(picture_), ReadOutcome::ok);
  EXPECT_EQ(picture_.number, 6U);
}

TEST_F(Pictures, ATooLargePictureIsCountedAndItsTimeNoted) {
  const std::vector<std::byte> in(65 * 48 * 3);
  EXPECT_FALSE(writer_->publish_picture({.time = 1, .width = 65, .height = 48}, in.data(), 65 * 3, {}));
  EXPECT_EQ(writer_->counted(Counter::pictures_too_large), 1U);
  EXPECT_EQ(reader_->picture(picture_), ReadOutcome::nothing);
  EXPECT_EQ(reader_->frame_rate().samples, 1U);
}

TEST_F(Pictures, TooManySamplesAreLeftOutAndCounted) {
  const auto in = pixels(8, 1, 8);
  const std::vector<PictureSample> line(40);
  writer_->publish_picture({.width = 8, .height = 1, .format = PixelFormat::gray8}, in.data(), 8, line);
  ASSERT_EQ(reader_->picture(picture_), ReadOutcome::ok);
  EXPECT_EQ(picture_.samples.size(), 32U);
  EXPECT_EQ(writer_->counted(Counter::picture_samples_dropped), 8U);
}

}  // namespace
}  // namespace linescope::testing
