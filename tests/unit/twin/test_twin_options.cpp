// What cannot be is refused with one sentence that says what to do.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "acquire/twin/virtual_experiment.hpp"
#include "common/units.hpp"

namespace linescope::twin {
namespace {

using testing::HasSubstr;

std::string refusal(const TwinOptions& options) {
  const auto made = VirtualExperiment::create(options);
  return made ? "accepted" : made.error().message;
}

TEST(TwinOptions, DemoIsValid) {
  EXPECT_EQ(refusal(demo_twin()), "accepted");
}

TEST(TwinOptions, AllNamedPresetsAreValid) {
  for (const char* noise : {"ideal", "manufacturer", "thesis"}) {
    for (const char* phantom : {"condyle", "plane", "cylinder-49", "mini-knee"}) {
      for (const char* instrument : {"camera-ii", "camera-ii-320"}) {
        TwinOptions options = demo_twin();
        options.instrument = *instrument_from_name(instrument);
        options.phantom = *phantom_from_name(phantom);
        ASSERT_TRUE(apply_noise_preset(options, noise));
        EXPECT_EQ(refusal(options), "accepted") << noise << ' ' << phantom << ' ' << instrument;
      }
    }
  }
}

TEST(TwinOptions, GapAtWhichTheLineLeavesThePictureIsRefused) {
  TwinOptions options = demo_twin();
  options.hand.gap_mm = 6;
  EXPECT_THAT(refusal(options), HasSubstr("at a gap of 6 mm the laser line is out of the picture"));
}

TEST(TwinOptions, PrismThatReflectsTotallyIsRefused) {
  TwinOptions options = demo_twin();
  options.optics.prism.refracted_sheet = true;
  options.optics.prism.prism_index = 1.34;
  EXPECT_THAT(refusal(options), HasSubstr("reflects totally"));
}

TEST(TwinOptions, UnknownNamesListTheKnownOnes) {
  EXPECT_THAT(instrument_from_name("camera-iii").error().message,
              HasSubstr("camera-i, camera-ii, camera-ii-320 or near"));
  EXPECT_THAT(optics_from_name("real").error().message, HasSubstr("ideal, clean, full or trouble"));
  EXPECT_THAT(tracker_noise_from_name("none").error().message, HasSubstr("ideal, manufacturer or thesis"));
  EXPECT_THAT(scenario_from_name("dance").error().message,
              HasSubstr("calibrate board, shake, pivot or spin"));
  TwinOptions options;
  EXPECT_THAT(apply_noise_preset(options, "loud").error().message,
              HasSubstr("ideal, manufacturer or thesis"));
}

TEST(TwinOptions, ImpossibleNumbersAreRefusedByName) {
  const auto with = [](auto change) {
    TwinOptions options = demo_twin();
    change(options);
    return refusal(options);
  };
  EXPECT_THAT(with([](auto& o) { o.duration = -1; }), HasSubstr("duration"));
  EXPECT_THAT(with([](auto& o) { o.instrument.exposure_ms = 50; }), HasSubstr("exposure"));
  EXPECT_THAT(with([](auto& o) { o.instrument.frame_rate_hz = 0; }), HasSubstr("pictures per second"));
  EXPECT_THAT(with([](auto& o) { o.instrument.baseline_mm = -1; }), HasSubstr("baseline"));
  EXPECT_THAT(with([](auto& o) { o.instrument.lens.width = 0; }), HasSubstr("pixels"));
  EXPECT_THAT(with([](auto& o) { o.instrument.lens.fx = std::nan(""); }), HasSubstr("focal"));
  EXPECT_THAT(with([](auto& o) { o.instrument.alpha_rad = 1.5; }), HasSubstr("69 degrees"));
  EXPECT_THAT(with([](auto& o) { o.tracker.rate_hz = 0; }), HasSubstr("tracker cycles"));
  EXPECT_THAT(with([](auto& o) { o.tracker.position_sigma_mm = -1; }), HasSubstr("tracker noise"));
  EXPECT_THAT(with([](auto& o) { o.tracker.field_wavelength_mm = 1; }), HasSubstr("wavelength"));
  EXPECT_THAT(with([](auto& o) { o.tracker.hemisphere.x() = std::nan(""); }), HasSubstr("hemisphere"));
  EXPECT_THAT(with([](auto& o) { o.optics.trouble.missing = 1.5; }), HasSubstr("missing share"));
  EXPECT_THAT(with([](auto& o) { o.optics.sensor.motion_samples = 0; }), HasSubstr("instants per exposure"));
  EXPECT_THAT(with([](auto& o) { o.optics.line.width_sigma_mm = 0; }), HasSubstr("line width"));
  EXPECT_THAT(with([](auto& o) { o.hand.sweep_seconds = 0; }), HasSubstr("sweep"));
  EXPECT_THAT(with([](auto& o) { o.hand.gap_variation_mm = 20; }), HasSubstr("gap"));
  EXPECT_THAT(with([](auto& o) { o.hand.sweeps = 0; }), HasSubstr("sweeps"));
  EXPECT_THAT(with([](auto& o) { o.hand.tilt_seconds = 0; }), HasSubstr("tilt"));
  EXPECT_THAT(with([](auto& o) { o.hand.tremor_mm = -1; }), HasSubstr("hand movement"));
  EXPECT_THAT(with([](auto& o) { o.hand.spots = -1; }), HasSubstr("spots"));
  EXPECT_THAT(with([](auto& o) { o.phantom.site_length_mm = 0; }), HasSubstr("donor site"));
  EXPECT_THAT(with([](auto& o) { o.phantom.condyle_semi_axes_mm.y() = 0; }), HasSubstr("semi-axes"));
}

TEST(TwinOptions, SpotsBesideThePhantomAreRefused) {
  TwinOptions options = demo_twin();
  options.phantom.condyle_semi_axes_mm = {5, 5, 5};
  EXPECT_THAT(refusal(options), HasSubstr("marked spots lie on the phantom"));
}

TEST(TwinOptions, DefaultInstrumentIsThesisCameraIIAtItsVideoSize) {
  const LensNumbers by_name = instrument_from_name("camera-ii")->lens, by_default;
  EXPECT_NEAR(by_default.fx, by_name.fx, 1e-9);
  EXPECT_NEAR(by_default.fy, by_name.fy, 1e-9);
  EXPECT_NEAR(by_default.cx, by_name.cx, 1e-9);
  EXPECT_NEAR(by_default.cy, by_name.cy, 1e-9);
  EXPECT_NEAR(InstrumentOptions{}.alpha_rad, radians_from_degrees(14), 1e-12);
}

}  // namespace
}  // namespace linescope::twin
