// Short ways to an experiment and its pictures.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string_view>
#include <vector>

#include "acquire/twin/twin_camera.hpp"
#include "acquire/twin/twin_tracker.hpp"
#include "acquire/twin/virtual_experiment.hpp"

namespace linescope::twin {

inline TwinOptions ideal_twin(std::string_view phantom = "condyle", Scenario scenario = Scenario::still) {
  TwinOptions options = demo_twin();
  EXPECT_TRUE(apply_noise_preset(options, "ideal"));
  options.phantom = *phantom_from_name(phantom);
  options.hand.scenario = scenario;
  return options;
}

inline std::shared_ptr<const VirtualExperiment> experiment(const TwinOptions& options) {
  auto made = VirtualExperiment::create(options);
  EXPECT_TRUE(made) << made.error().message;
  return *made;
}

inline std::vector<Frame> pictures(const TwinOptions& options, int count) {
  TwinCamera camera(experiment(options));
  EXPECT_TRUE(camera.start());
  std::vector<Frame> frames;
  for (int i = 0; i < count; ++i) {
    Frame frame;
    EXPECT_EQ(camera.next(frame), Pull::item);
    frames.push_back(frame);
  }
  return frames;
}

inline cv::Mat picture(const TwinOptions& options) {
  return pictures(options, 1).front().bgr;
}

inline std::vector<PoseSample> samples(const TwinOptions& options, int count) {
  TwinTracker tracker(experiment(options));
  EXPECT_TRUE(tracker.start());
  std::vector<PoseSample> all(static_cast<std::size_t>(count));
  for (PoseSample& sample : all) EXPECT_EQ(tracker.next(sample), Pull::item);
  return all;
}

}  // namespace linescope::twin
