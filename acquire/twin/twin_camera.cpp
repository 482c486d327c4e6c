#include "acquire/twin/twin_camera.hpp"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "acquire/twin/renderer.hpp"

namespace linescope::twin {

TwinCamera::TwinCamera(std::shared_ptr<const VirtualExperiment> experiment)
    : experiment_(std::move(experiment)) {}
TwinCamera::~TwinCamera() = default;

Result<void> TwinCamera::start() {
  const TwinTruth& truth = experiment_->truth();
  renderer_ = std::make_unique<Renderer>(experiment_->options(), truth.phantom(), experiment_->sheet());
  next_index_ = 0;
  status_ = {};
  status_.state = CameraState::waiting;
  return {};
}

Nanoseconds TwinCamera::exposure_middle(std::uint64_t index) const {
  const InstrumentOptions& instrument = experiment_->options().instrument;
  const double seconds =
      static_cast<double>(index) / instrument.frame_rate_hz + 0.5e-3 * instrument.exposure_ms;
  return experiment_->options().start + std::llround(seconds * 1e9);
}

Result<Pull> TwinCamera::next(Frame& frame) {
  if (!renderer_) return fail(ErrorCode::usage, "the simulated camera was not started");
  const TwinOptions& options = experiment_->options();
  const Nanoseconds middle = exposure_middle(next_index_);
  if (options.duration > 0 && middle >= options.start + options.duration) {
    status_.state = CameraState::ended;
    return Pull::end;
  }
  const int samples = options.optics.sensor.motion_samples;
  std::vector<Glance> glances;
  for (int k = 0; k < samples; ++k) {
    const double part = (k + 0.5) / samples - 0.5;
    const Nanoseconds time = middle + std::llround(part * options.instrument.exposure_ms * 1e6);
    glances.push_back({experiment_->truth().phantom_from_camera(time), seconds_from(time - options.start)});
  }
  renderer_->render(glances, next_index_, frame.bgr);
  frame.time = middle + options.instrument.latency;
  frame.index = next_index_++;
  frame.name.clear();
  status_.state = CameraState::ok;
  ++status_.counters.delivered;
  return Pull::item;
}

std::string TwinCamera::description() const {
  const TwinOptions& options = experiment_->options();
  return fmt::format("digital twin, {} by {}x{} at {:g} Hz, seed {}", name(options.phantom),
                     options.instrument.lens.width, options.instrument.lens.height,
                     options.instrument.frame_rate_hz, options.seed);
}

CameraStatus TwinCamera::status() const {
  return status_;
}

Nanoseconds TwinCamera::period() const {
  return std::llround(1e9 / experiment_->options().instrument.frame_rate_hz);
}

}  // namespace linescope::twin
