#include "tools/evaluate/virtual_session.hpp"

#include "acquire/twin/twin_camera.hpp"
#include "acquire/twin/twin_tracker.hpp"

namespace linescope::evaluate {
namespace {

using Pictures = std::shared_ptr<const std::vector<Frame>>;

/// Pictures that were rendered before, once more.
class RememberedCamera final : public CameraSource {
 public:
  RememberedCamera(Pictures pictures, Nanoseconds period) : pictures_(std::move(pictures)), period_(period) {}

  Result<void> start() override {
    next_ = 0;
    return {};
  }
  Result<Pull> next(Frame& frame) override {
    if (next_ == pictures_->size()) return Pull::end;
    frame = (*pictures_)[next_++];  // shares the pixels; nobody writes into a source's picture
    return Pull::item;
  }
  bool live() const override { return false; }
  std::string description() const override { return "digital twin, rendered before"; }
  CameraStatus status() const override {
    CameraStatus status;
    status.state = next_ < pictures_->size() ? CameraState::ok : CameraState::ended;
    status.counters.delivered = next_;
    return status;
  }
  Nanoseconds period() const override { return period_; }

 private:
  Pictures pictures_;
  Nanoseconds period_;
  std::size_t next_ = 0;
};

Result<std::shared_ptr<const twin::VirtualExperiment>> finite_experiment(const twin::TwinOptions& options) {
  if (options.duration <= 0)
    return fail(ErrorCode::usage, "an experiment to be evaluated needs an end: give it a duration");
  return twin::VirtualExperiment::create(options);
}

}  // namespace

Result<VirtualSession> VirtualSession::render(const twin::TwinOptions& options) {
  auto experiment = finite_experiment(options);
  if (!experiment) return tl::unexpected(experiment.error());
  twin::TwinCamera camera(*experiment);
  if (auto ok = camera.start(); !ok) return tl::unexpected(ok.error());
  auto pictures = std::make_shared<std::vector<Frame>>();
  for (;;) {
    Frame frame;
    auto pulled = camera.next(frame);
    if (!pulled) return tl::unexpected(pulled.error());
    if (*pulled == Pull::end) break;
    pictures->push_back(std::move(frame));
  }
  return VirtualSession(*experiment, std::move(pictures));
}

Result<VirtualSession> VirtualSession::without_pictures(const twin::TwinOptions& options) {
  auto experiment = finite_experiment(options);
  if (!experiment) return tl::unexpected(experiment.error());
  // A run ends with its pictures: one black one at the very end lets all samples pass before.
  const twin::LensNumbers& lens = options.instrument.lens;
  Frame last;
  last.bgr = cv::Mat::zeros(lens.height, lens.width, CV_8UC3);
  last.time = options.start + options.duration;
  return VirtualSession(*experiment,
                        std::make_shared<const std::vector<Frame>>(std::vector<Frame>{std::move(last)}));
}

Result<Session> VirtualSession::acquire(const SessionOptions& options) const {
  const double rate = experiment_->options().instrument.frame_rate_hz;
  Sources sources;
  sources.camera = std::make_unique<RememberedCamera>(pictures_, nanoseconds_from_seconds(1 / rate));
  sources.tracker = std::make_unique<twin::TwinTracker>(experiment_);
  sources.calibration = experiment_->calibration();
  if (auto ok = sources.camera->start(); !ok) return tl::unexpected(ok.error());
  if (auto ok = sources.tracker->start(); !ok) return tl::unexpected(ok.error());
  return run_session(std::move(sources), options);
}

Rigid<twin::PhantomFrame, Object> VirtualSession::phantom_from_object() const {
  const Nanoseconds start = experiment_->options().start;
  const twin::TwinTruth& t = truth();
  return t.phantom_from_camera(start) * t.world_from_camera(start).inverse() * t.world_from_object(start);
}

SessionOptions thesis_session() {
  SessionOptions options;
  options.laser.centre = CentreMethod::weighted_mean;
  return options;
}

SessionOptions better_session() {
  return {};
}

}  // namespace linescope::evaluate
