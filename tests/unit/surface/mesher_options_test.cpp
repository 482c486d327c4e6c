#include "viewer/surface/mesher_options.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "viewer/surface/mesher.hpp"

namespace linescope {
namespace {

TEST(MesherOptions, DefaultsAndTheThesisIntervalsAreValid) {
  EXPECT_TRUE(validate({}).has_value());
  for (const double interval : kThesisIntervals) EXPECT_TRUE(validate({.interval = interval}).has_value());
  EXPECT_TRUE(validate({.interval = 0.001}).has_value());
  EXPECT_TRUE(validate({.interval = 1e6}).has_value());
}

TEST(MesherOptions, AnImpossibleIntervalIsOneSentence) {
  for (const double interval :
       {0.0, -1.27, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    const auto made = make_mesher({.interval = interval});
    ASSERT_FALSE(made.has_value()) << interval;
    EXPECT_EQ(made.error().code, ErrorCode::invalid);
    EXPECT_THAT(made.error().message, ::testing::HasSubstr("interval"));
    EXPECT_THAT(made.error().message, ::testing::HasSubstr("positive"));
  }
}

TEST(MesherOptions, EveryValueOutOfRangeIsNamed) {
  const std::pair<const char*, std::function<void(MesherOptions&)>> faults[] = {
      {"max_distance", [](MesherOptions& o) { o.max_distance = 0; }},
      {"max_deviation", [](MesherOptions& o) { o.max_deviation = -1; }},
      {"isovalue", [](MesherOptions& o) { o.isovalue = 0; }},
      {"typical_deviation", [](MesherOptions& o) { o.typical_deviation = std::nan(""); }},
      {"typical_curvature", [](MesherOptions& o) { o.typical_curvature = 0; }},
      {"min_points", [](MesherOptions& o) { o.min_points = 0; }},
      {"min_lines", [](MesherOptions& o) { o.min_lines = 0; }},
      {"fill_holes_up_to", [](MesherOptions& o) { o.fill_holes_up_to = -1; }},
      {"sweep_pause", [](MesherOptions& o) { o.sweep_pause = 0; }},
      {"max_memory", [](MesherOptions& o) { o.max_memory = 10; }},
  };
  for (const auto& [name, break_it] : faults) {
    MesherOptions options;
    break_it(options);
    const auto valid = validate(options);
    ASSERT_FALSE(valid.has_value()) << name;
    EXPECT_THAT(valid.error().message, ::testing::HasSubstr(name));
  }
}

}  // namespace
}  // namespace linescope
