#include "tools/studies/navigation_study_scan.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>

#include "acquire/acquisition.hpp"
#include "acquire/twin/twin_camera.hpp"
#include "acquire/twin/twin_tracker.hpp"
#include "acquire/twin/virtual_experiment.hpp"
#include "ipc/heartbeat.hpp"
#include "ipc/segment_reader.hpp"
#include "viewer/line_placer.hpp"

namespace linescope::study {
namespace {

SegmentOptions segment_options(const CameraModel& camera, Nanoseconds duration) {
  static std::atomic<int> number{0};
  SegmentOptions o;
  o.name = fmt::format("linescope-study-{}-{}", ::getpid(), ++number);
  o.line_capacity = static_cast<std::uint32_t>(60 * seconds_from(duration)) + 60;
  o.point_capacity = o.line_capacity * static_cast<std::uint32_t>(camera.width);
  o.picture_bytes = static_cast<std::uint32_t>(camera.width * camera.height) * 3;
  o.picture_samples =
      std::max(o.picture_samples, static_cast<std::uint32_t>(std::max(camera.width, camera.height)));
  return o;
}

AcquireOptions acquire_options(Nanoseconds mean_over) {
  AcquireOptions o;
  o.run.pace = Pace::fast;
  o.run.exit_at_end = true;
  o.tracker.history.mean_over = mean_over;
  return o;
}

Result<Sources> started_sources(const twin::TwinOptions& options) {
  auto experiment = twin::VirtualExperiment::create(options);
  if (!experiment) return tl::unexpected(experiment.error());
  Sources sources;
  sources.camera = std::make_unique<twin::TwinCamera>(*experiment);
  sources.tracker = std::make_unique<twin::TwinTracker>(*experiment);
  sources.calibration = (*experiment)->calibration();
  if (auto ok = sources.camera->start(); !ok) return tl::unexpected(ok.error());
  if (auto ok = sources.tracker->start(); !ok) return tl::unexpected(ok.error());
  return sources;
}

Result<HeldLines> held_lines(const std::string& segment, const Calibration& calibration) {
  auto reader = SegmentReader::attach({.name = segment});
  if (!reader) return tl::unexpected(reader.error());
  LinePlacer placer(HeldIn::object);
  placer.set_camera(calibration.endoscope_from_camera);
  LineCursor cursor;
  LineBatch batch;
  HeldLines lines;
  do {
    if (reader->read_lines(cursor, batch) != ReadOutcome::ok) break;
    for (const Line& line : batch.lines)
      if (auto placed = placer.place(line, batch.points_of(line))) lines.push_back(*placed);
  } while (batch.more);
  return lines;
}

}  // namespace

Result<StudyScan> scan_twin(const twin::TwinOptions& options, Nanoseconds mean_over) {
  auto sources = started_sources(options);
  if (!sources) return tl::unexpected(sources.error());
  StudyScan result;
  result.calibration = sources->calibration;
  auto writer = SegmentWriter::create(segment_options(result.calibration.camera, options.duration));
  if (!writer) return tl::unexpected(writer.error());
  const Heartbeat heartbeat(*writer);
  std::atomic<bool> stop{false};
  auto acquisition = Acquisition::create(acquire_options(mean_over), std::move(*sources), *writer, stop);
  if (!acquisition) return tl::unexpected(acquisition.error());
  (*acquisition)->scan.start(monotonic_now());
  run_stepped(**acquisition);
  auto lines = held_lines(writer->name(), result.calibration);
  if (!lines) return tl::unexpected(lines.error());
  result.lines = std::move(*lines);
  return result;
}

}  // namespace linescope::study
