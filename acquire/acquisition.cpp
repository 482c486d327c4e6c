#include "acquire/acquisition.hpp"

namespace linescope {

Acquisition::Acquisition(const AcquireOptions& options, Sources given, LineReconstructor reconstructor,
                         SegmentWriter& writer, std::atomic<bool>& stop_flag)
    : run(options.run),
      longest_wait(options.tracker.longest_wait),
      sources(std::move(given)),
      stop(stop_flag),
      history(options.tracker.history),
      poses(history, options.tracker.roles, options.tracker.longest_wait),
      scan(writer),
      laser(options.camera.line_exposure, options.camera.exposure_ms, *sources.camera),
      desk(writer, scan, laser, stop),
      state(*sources.camera, sources.tracker.get(), writer),
      pipeline(options.laser, std::move(reconstructor), poses, writer) {
  state.watch(&laser);
  if (sources.tracker)
    intake = std::make_unique<PoseIntake>(*sources.tracker, options.tracker.roles, history, writer);
}

Result<std::unique_ptr<Acquisition>> Acquisition::create(const AcquireOptions& options, Sources sources,
                                                         SegmentWriter& writer, std::atomic<bool>& stop) {
  auto reconstructor = LineReconstructor::create(sources.calibration, options.reconstruct);
  if (!reconstructor) return tl::unexpected(reconstructor.error());
  return std::unique_ptr<Acquisition>(
      new Acquisition(options, std::move(sources), std::move(*reconstructor), writer, stop));
}

void Acquisition::record_to(std::unique_ptr<Recorder> new_recorder) {
  recorder = std::move(new_recorder);
  desk.record_to(recorder.get());
  state.watch(recorder.get());
}

}  // namespace linescope
