// Rendered pictures through the product's extraction and reconstruction, at the true poses: what comes back
// is the phantom.
#include <gtest/gtest.h>

#include <cmath>

#include "acquire/laser/line_extractor.hpp"
#include "acquire/reconstruct/line_reconstructor.hpp"
#include "twin_fixture.hpp"

namespace linescope::twin {
namespace {

struct Errors {
  std::size_t points = 0;
  double mean = 0, rms = 0;
};

Errors measured(const TwinOptions& options, int count) {
  const auto twin = experiment(options);
  LineExtractor extractor({});
  const auto reconstructor = LineReconstructor::create(twin->calibration(), {});
  EXPECT_TRUE(reconstructor) << reconstructor.error().message;
  Errors errors;
  ReconstructedLine line;
  for (const Frame& frame : pictures(options, count)) {
    const TwinTruth& truth = twin->truth();
    EXPECT_TRUE(reconstructor->reconstruct(extractor.extract(frame.bgr),
                                           truth.world_from_endoscope(frame.time), line));
    const auto object_from_world = truth.world_from_object(frame.time).inverse();
    for (const SurfacePoint& point : line.points) {
      const double error = truth.distance(object_from_world * point.position.cast<double>());
      errors.mean += error;
      errors.rms += error * error;
    }
    errors.points += line.points.size();
  }
  errors.mean /= static_cast<double>(errors.points);
  errors.rms = std::sqrt(errors.rms / static_cast<double>(errors.points));
  return errors;
}

class WholeChain : public testing::TestWithParam<const char*> {};

TEST_P(WholeChain, ReturnsThePhantomWithinAHundredthOfAMillimetre) {
  const Errors errors = measured(ideal_twin(GetParam(), Scenario::sweeps), 40);
  EXPECT_GT(errors.points, 40u * 100);
  EXPECT_LT(errors.rms, 0.01);
  EXPECT_LT(std::abs(errors.mean), 0.002);
}

TEST_P(WholeChain, DoesSoThroughTheDistortedLensToo) {
  TwinOptions options = ideal_twin(GetParam(), Scenario::sweeps);
  options.instrument = *instrument_from_name("camera-ii");
  const Errors errors = measured(options, 40);
  EXPECT_GT(errors.points, 40u * 100);
  EXPECT_LT(errors.rms, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Phantoms, WholeChain, testing::Values("plane", "condyle", "cylinder-50"),
                         [](const testing::TestParamInfo<const char*>& instance) {
                           return std::string(instance.param).substr(0, 5);
                         });

// A wrong calibration must show: otherwise the tests above prove nothing.
TEST(WholeChain, AWrongBaselineIsSeen) {
  const TwinOptions options = ideal_twin("plane");
  const auto twin = experiment(options);
  Calibration wrong = twin->calibration();
  wrong.laser.offset *= 1.01;
  LineExtractor extractor({});
  const auto reconstructor = LineReconstructor::create(wrong, {});
  ASSERT_TRUE(reconstructor);
  const Frame frame = pictures(options, 1).front();
  ReconstructedLine line;
  ASSERT_TRUE(reconstructor->reconstruct(extractor.extract(frame.bgr),
                                         twin->truth().world_from_endoscope(frame.time), line));
  ASSERT_FALSE(line.points.empty());
  const auto object_from_world = twin->truth().world_from_object(frame.time).inverse();
  // One per cent of the baseline is one per cent of the depth: 0.15 mm at 15 mm, below the surface.
  EXPECT_NEAR(twin->truth().distance(object_from_world * line.points[50].position.cast<double>()), -0.15,
              0.02);
}

}  // namespace
}  // namespace linescope::twin
