#include "tools/evaluate/session_run.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <limits>

#include "acquire/acquisition.hpp"
#include "ipc/segment_reader.hpp"
#include "viewer/line_placer.hpp"

namespace linescope::evaluate {
namespace {

/// A name nobody else has: several sessions may run at once.
std::string segment_name() {
  static std::atomic<unsigned> counter{0};
  return fmt::format("linescope-evaluate-{}-{}", ::getpid(), counter++);
}

SegmentOptions segment_options(const SessionOptions& options, const CameraModel& camera) {
  SegmentOptions o;
  o.name = segment_name();
  o.program = "linescope-evaluate";
  const auto profiles = static_cast<std::uint32_t>(std::max(camera.width, camera.height));
  o.line_capacity = options.lines;
  o.points_per_line = profiles;
  o.point_capacity = options.lines * profiles;
  o.picture_bytes = static_cast<std::uint32_t>(camera.width * camera.height) * 3;
  o.picture_samples = profiles;
  o.pose_history = options.pose_history;
  return o;
}

AcquireOptions acquire_options(const SessionOptions& options) {
  AcquireOptions o;
  o.run.pace = Pace::fast;
  o.run.exit_at_end = true;
  o.laser = options.laser;
  o.reconstruct = options.reconstruct;
  o.tracker.roles = options.roles;
  o.tracker.history = options.history;
  return o;
}

void place_lines(const LineBatch& batch, const Calibration& calibration, HeldIn held_in, Session& session) {
  LinePlacer placer(held_in);
  placer.set_camera(calibration.endoscope_from_camera);
  for (const Line& line : batch.lines) {
    if (auto placed = placer.place(line, batch.points_of(line))) session.lines.push_back(*placed);
  }
}

Result<Session> read_back(const std::string& segment, const Calibration& calibration,
                          const StationRoles& roles) {
  auto reader = SegmentReader::attach({.name = segment});
  if (!reader) return tl::unexpected(reader.error());
  Session session;
  LineCursor cursor;
  LineBatch batch;
  do {
    const ReadOutcome outcome = reader->read_lines(cursor, batch);
    if (outcome == ReadOutcome::nothing) break;
    if (outcome != ReadOutcome::ok)
      return fail(ErrorCode::internal, fmt::format("the session's lines cannot be read: {}", name(outcome)));
    place_lines(batch, calibration, roles.object < 0 ? HeldIn::world : HeldIn::object, session);
  } while (batch.more);
  const std::array stations{roles.endoscope, roles.object, roles.harvester};
  for (std::size_t i = 0; i < stations.size(); ++i) {
    if (stations[i] < 0) continue;
    reader->pose_history(stations[i], 0, std::numeric_limits<Nanoseconds>::max(), session.poses[i]);
  }
  session.counters = reader->counters();
  return session;
}

}  // namespace

std::size_t Session::points() const {
  std::size_t sum = 0;
  for (const auto& line : lines) sum += line->points.size();
  return sum;
}

std::uint64_t Session::count(Counter counter) const {
  for (const CounterValue& c : counters)
    if (c.name == name(counter)) return c.value;
  return 0;
}

StationRoles roles_of(const RecordingInfo& info) {
  return {info.endoscope_station, info.object_station, info.harvester_station};
}

Result<Session> run_recording(const std::filesystem::path& folder, const StationRoles& roles,
                              const SessionOptions& algorithms) {
  AcquireOptions replay;
  replay.run.replay = folder;
  replay.run.pace = Pace::fast;
  auto sources = make_sources(replay, 0);
  if (!sources) return fail(ErrorCode::unreadable, sources.error().message);
  SessionOptions options = algorithms;
  options.roles = roles;
  options.lines = 20'000;
  return run_session(std::move(*sources), options);
}

Result<Session> run_session(Sources sources, const SessionOptions& options) {
  const Calibration calibration = sources.calibration;
  const SegmentOptions segment = segment_options(options, calibration.camera);
  auto writer = SegmentWriter::create(segment);
  if (!writer) return tl::unexpected(writer.error());
  std::atomic<bool> stop{false};
  auto acquisition = Acquisition::create(acquire_options(options), std::move(sources), *writer, stop);
  if (!acquisition) return tl::unexpected(acquisition.error());
  (*acquisition)->scan.start(monotonic_now());
  run_stepped(**acquisition);
  return read_back(segment.name, calibration, options.roles);
}

}  // namespace linescope::evaluate
