#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "acquire/laser/line_extractor.hpp"

namespace linescope {
namespace {

using ::testing::HasSubstr;

TEST(LaserColour, EveryNameLeadsBackToItsColour) {
  for (const LaserColour c : {LaserColour::blue, LaserColour::green, LaserColour::cyan, LaserColour::red,
                              LaserColour::violet, LaserColour::yellow, LaserColour::mono}) {
    const auto back = laser_colour_from_name(name(c));
    ASSERT_TRUE(back) << name(c);
    EXPECT_EQ(*back, c);
  }
}

TEST(LaserColour, AnUnknownNameIsAnsweredWithTheKnownOnes) {
  const auto colour = laser_colour_from_name("grene");
  ASSERT_FALSE(colour);
  EXPECT_EQ(colour.error().code, ErrorCode::invalid);
  EXPECT_THAT(colour.error().message, HasSubstr("'grene'"));
  EXPECT_THAT(colour.error().message, HasSubstr("red, green, blue"));
}

TEST(LineExtractorOptions, DefaultsAreValid) {
  EXPECT_TRUE(validate(LineExtractorOptions{}));
}

struct Bad {
  const char* name;
  std::function<void(LineExtractorOptions&)> spoil;
};

class ImpossibleOption : public ::testing::TestWithParam<Bad> {};

TEST_P(ImpossibleOption, IsNamedInOneSentence) {
  LineExtractorOptions options;
  GetParam().spoil(options);
  const auto result = validate(options);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::invalid);
  EXPECT_THAT(result.error().message, HasSubstr(GetParam().name));
}

INSTANTIATE_TEST_SUITE_P(
    Each, ImpossibleOption,
    ::testing::Values(Bad{"colour", [](auto& o) { o.colour = static_cast<LaserColour>(0); }},
                      Bad{"colour_threshold", [](auto& o) { o.colour_threshold = 0; }},
                      Bad{"ridge_threshold", [](auto& o) { o.ridge_threshold = 255; }},
                      Bad{"ridge_reach", [](auto& o) { o.ridge_reach = 1; }},
                      Bad{"colour_ratio", [](auto& o) { o.colour_ratio = 0.9; }},
                      Bad{"merge_gap", [](auto& o) { o.merge_gap = -1; }},
                      Bad{"saturation_level", [](auto& o) { o.saturation_level = 256; }},
                      Bad{"min_width", [](auto& o) { o.min_width = -0.1; }},
                      Bad{"max_width", [](auto& o) { o.max_width = 0.5 * o.min_width; }},
                      Bad{"max_saturated", [](auto& o) { o.max_saturated = -1; }},
                      Bad{"min_snr", [](auto& o) { o.min_snr = std::nan(""); }},
                      Bad{"relative_threshold", [](auto& o) { o.relative_threshold = 1; }},
                      Bad{"border", [](auto& o) { o.border = -1; }},
                      Bad{"min_run", [](auto& o) { o.min_run = 0; }},
                      Bad{"max_step", [](auto& o) { o.max_step = 0; }},
                      Bad{"max_gap", [](auto& o) { o.max_gap = 65; }},
                      Bad{"ambiguity", [](auto& o) { o.ambiguity = 1.01; }}),
    [](const auto& i) { return std::string(i.param.name); });

}  // namespace
}  // namespace linescope
