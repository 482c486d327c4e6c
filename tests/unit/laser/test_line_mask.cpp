#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>
#include <vector>

#include "acquire/laser/line_mask.hpp"
#include "acquire/laser/line_mask_detail.hpp"

namespace linescope {
namespace {

/// A picture whose last byte is the last byte of its memory, so that a sanitizer sees every step beyond.
struct Picture {
  Picture(int w, int h, int padding, unsigned seed) {
    const std::ptrdiff_t stride = 3 * w + padding;
    const std::size_t size = static_cast<std::size_t>(stride * (h - 1) + 3 * w);
    bytes = std::make_unique<std::uint8_t[]>(size);
    std::mt19937 generator(seed);
    std::uniform_int_distribution<int> any(0, 255), kind(0, 3);
    // Mostly dull, so that both outcomes of each test occur.
    for (std::size_t i = 0; i < size; ++i)
      bytes[i] = static_cast<std::uint8_t>(kind(generator) == 0 ? any(generator) : any(generator) / 8);
    view = {bytes.get(), stride, w, h, 3};
  }
  std::unique_ptr<std::uint8_t[]> bytes;
  PictureView view;
};

std::vector<std::uint32_t> marks(Marker marker, const PictureView& view, const MaskRule& rule) {
  const auto words = static_cast<std::size_t>(mask_words(view.width));
  std::vector<std::uint32_t> all(words * static_cast<std::size_t>(view.height), 0xDEADBEEF);
  marker(view, rule, all.data());
  return all;
}

bool bit(const std::vector<std::uint32_t>& all, const PictureView& view, int x, int y) {
  return (all[static_cast<std::size_t>(y * mask_words(view.width) + x / 32)] >> (x % 32) & 1U) != 0;
}

TEST(LineMask, ColourTestIsTheDefinition) {
  const Picture p(70, 9, 5, 3);
  for (unsigned on = 1; on <= 7; ++on) {
    MaskRule rule;
    rule.on = on;
    rule.ridge_threshold = 256;
    rule.colour_threshold = 20;
    const auto all = marks(&mark_picture, p.view, rule);
    for (int y = 0; y < p.view.height; ++y) {
      for (int x = 0; x < p.view.width; ++x) {
        const std::uint8_t* v = p.view.data + p.view.stride * y + 3 * x;
        int lit = 255, dark = 0;
        for (unsigned c = 0; c < 3; ++c)
          (on >> c & 1U) != 0 ? lit = std::min<int>(lit, v[c]) : dark = std::max<int>(dark, v[c]);
        EXPECT_EQ(bit(all, p.view, x, y), lit - dark >= 20) << "colour " << on << " at " << x << ", " << y;
      }
    }
  }
}

TEST(LineMask, RidgeTestAsksBothSidesThatLieInThePicture) {
  Picture p(64, 60, 0, 1);
  std::fill_n(p.bytes.get(), 3 * 64 * 60, std::uint8_t{40});
  const auto green = [&](int x, int y) -> std::uint8_t& {
    return p.bytes[static_cast<std::size_t>(3 * (64 * y + x) + 1)];
  };
  green(10, 30) = 60;                  // 20 above both sides
  green(11, 30) = green(11, 40) = 60;  // as bright 10 px below: no ridge
  green(12, 3) = 60;                   // only the lower side lies in the picture
  green(13, 57) = 60;                  // only the upper one
  MaskRule rule;
  rule.colour_threshold = 256;
  rule.ridge_threshold = 20;
  rule.reach = 10;
  const auto all = marks(&mark_picture, p.view, rule);
  EXPECT_TRUE(bit(all, p.view, 10, 30));
  EXPECT_FALSE(bit(all, p.view, 11, 30));
  EXPECT_TRUE(bit(all, p.view, 11, 40) == false);
  EXPECT_TRUE(bit(all, p.view, 12, 3));
  EXPECT_TRUE(bit(all, p.view, 13, 57));
  EXPECT_FALSE(bit(all, p.view, 30, 30));
  rule.ridge_threshold = 21;
  EXPECT_FALSE(bit(marks(&mark_picture, p.view, rule), p.view, 10, 30));
}

using Maker = Marker (*)(const MaskRule&);

class VectorMask : public ::testing::TestWithParam<Maker> {};

TEST_P(VectorMask, MarksTheSamePixelsAsThePlainLoop) {
  unsigned seed = 0;
  for (unsigned on = 1; on <= 7; ++on) {
    for (const ProfileAxis axis : {ProfileAxis::column, ProfileAxis::row}) {
      for (const int width : {16, 31, 32, 33, 63, 64, 96, 97, 128, 161, 200, 257}) {
        for (const int ridge : {256, 15}) {
          MaskRule rule;
          rule.on = on;
          rule.lead = leading_channel(static_cast<LaserColour>(on));
          rule.axis = axis;
          rule.ridge_threshold = ridge;
          rule.reach = width % 2 == 0 ? 24 : 7;
          const Marker marker = GetParam()(rule);
          if (marker == nullptr) GTEST_SKIP() << "this processor has no such vectors";
          const Picture p(width, 40, width % 3 == 0 ? 0 : 13, ++seed);
          ASSERT_EQ(marks(marker, p.view, rule), marks(&mark_picture, p.view, rule))
              << "colour " << on << ", width " << width << ", axis " << static_cast<int>(axis) << ", ridge "
              << ridge;
        }
      }
    }
  }
}

/// Pictures without gaps between rows, in which the rows between those marked together are taken as one.
TEST_P(VectorMask, MarksTheSamePixelsWhereRowsFollowOneAnother) {
  unsigned seed = 500;
  for (const int width : {32, 64, 96, 160}) {
    for (const int height : {40, 96, 100, 119, 120, 203}) {
      for (const int ridge : {256, 15}) {
        MaskRule rule;
        rule.ridge_threshold = ridge;
        rule.reach = 10;
        const Marker marker = GetParam()(rule);
        if (marker == nullptr) GTEST_SKIP() << "this processor has no such vectors";
        const Picture p(width, height, 0, ++seed);
        ASSERT_EQ(marks(marker, p.view, rule), marks(&mark_picture, p.view, rule))
            << width << " x " << height << ", ridge " << ridge;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Widths, VectorMask,
                         ::testing::Values(&mask_detail::avx2_marker, &mask_detail::avx512_marker),
                         [](const auto& i) { return i.index == 0 ? "Avx2" : "Avx512"; });

TEST(LineMask, MonoIsFoundByRidgesUnlessTheMeanIsAskedFor) {
  LineExtractorOptions options;
  options.colour = LaserColour::mono;
  EXPECT_EQ(mask_rule(options, 3).colour_threshold, 256);
  EXPECT_TRUE(mask_rule(options, 3).ridge());
  options.centre = CentreMethod::weighted_mean;
  EXPECT_EQ(mask_rule(options, 3).colour_threshold, options.colour_threshold);
  EXPECT_FALSE(mask_rule(options, 3).ridge());
}

}  // namespace
}  // namespace linescope
