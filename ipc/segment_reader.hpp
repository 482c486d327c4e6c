// A reader of a segment: viewer, recorder, bridge. Maps read-only; nothing it does disturbs the writer.
//
// Every read copies out and is consistent, or says that it is not (ReadOutcome). Every retry is bounded. All
// sizes, offsets and indices are checked against the mapping. One object belongs to one thread; several
// objects may be attached at once.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/pose_sample.hpp"
#include "common/result.hpp"
#include "common/surface_point.hpp"
#include "ipc/line_batch.hpp"
#include "ipc/segment_statistics.hpp"
#include "ipc/segment_types.hpp"

namespace linescope {

/// How the writer is doing.
enum class Life {
  live,
  silent,    ///< no heartbeat for more than 150 ms: dead, stopped or starved. May come back.
  closed,    ///< ended in good order
  replaced,  ///< another writer has the name: attach again
  removed,   ///< the name is gone, without an orderly end
  damaged,   ///< the mapping was cut short or its identity was overwritten: detach
};
std::string_view name(Life life);

struct LifeReport {
  Life life = Life::live;
  Nanoseconds silent_for = 0;  ///< since the last heartbeat
  std::string text;            ///< one sentence for people; empty while live
};

/// What a read gave.
enum class ReadOutcome {
  ok,
  nothing,    ///< nothing was published there yet
  overtaken,  ///< the writer was faster than the copying, several times: try again later
  corrupt,    ///< the segment holds an impossible number: detach
};
std::string_view name(ReadOutcome outcome);

struct AttachOptions {
  std::string name = "linescope";
  bool other_owner = false;  ///< accept a segment that belongs to another user than us or root
  bool prefault = true;      ///< map all pages now (milliseconds) instead of on first touch
  bool wake_ups = true;  ///< open the control segment's wake-up word, so that wait() sleeps; else it polls
};

struct SegmentIdentity {
  std::string name;
  std::string program;
  std::string control_name;
  std::uint64_t session_id = 0;
  std::uint32_t writer_pid = 0;
  std::uint32_t writer_uid = 0;
  std::uint32_t layout_major = 0, layout_minor = 0;
  Nanoseconds started = 0;      ///< CLOCK_MONOTONIC
  Nanoseconds started_utc = 0;  ///< CLOCK_REALTIME
  std::size_t bytes = 0;
  std::uint32_t point_capacity = 0, line_capacity = 0, pose_history = 0;
};

/// The latest picture; buffers are reused from call to call.
struct Picture {
  Nanoseconds time = 0;
  std::uint64_t frame = 0;
  std::uint64_t number = 0;  ///< pictures published so far; gaps tell how many were left out
  std::uint32_t width = 0, height = 0, stride = 0;  ///< px, px, bytes
  PixelFormat format = PixelFormat::bgr8;
  std::string name;
  std::vector<std::byte> pixels;
  std::vector<PictureSample> samples;
};

/// Where a reader stands in the samples of one station. A fresh one begins with the first sample of the
/// session.
struct PoseCursor {
  std::uint64_t next = 0;        ///< running number of the first sample not yet seen
  std::uint64_t session_id = 0;  ///< a cursor of another session begins from scratch
};

class SegmentReader {
 public:
  /// One sentence per reason: `not_found` (no daemon yet), `permission` (other user, mode), `mismatch` (not a
  /// segment, other layout version or byte order), `unreadable` (truncated, size not as its header says,
  /// impossible tables), `busy` (is being set up: try again).
  static Result<SegmentReader> attach(const AttachOptions& options);
  ~SegmentReader();
  SegmentReader(SegmentReader&&) noexcept;
  SegmentReader& operator=(SegmentReader&&) noexcept;

  const SegmentIdentity& identity() const;

  /// One cheap system call (is the mapping still whole?); where the name leads is looked up at most every 50
  /// ms.
  Life life(Nanoseconds now) const;
  /// The same with age and sentence.
  LifeReport report(Nanoseconds now) const;

  /// Sleeps until something of `topics` was published since the last wait, the writer falls silent, or the
  /// time is over. True when there is something new. The first call is true when anything was ever published.
  bool wait(Topic topics, Nanoseconds timeout);
  /// Whether something of `topics` is new, without sleeping and without a system call: made for polling in a
  /// loop. The one call that does not look whether the mapping was cut short; look with life() now and then.
  bool news(Topic topics);

  ReadOutcome status(DaemonStatus& out) const;
  ReadOutcome sensor_status(int station, SensorStatus& out) const;
  ReadOutcome camera_status(CameraReport& out) const;
  ReadOutcome configuration(std::string& toml) const;
  ReadOutcome calibration(std::string& yaml) const;
  bool scanning() const;
  bool full() const;

  ReadOutcome latest_pose(int station, PoseSample& out) const;
  /// Samples of a station with from <= time <= to, oldest first, appended to `out`. overtaken: the history
  /// does not reach back to `from` any more; what is there was appended.
  ReadOutcome pose_history(int station, Nanoseconds from, Nanoseconds to, std::vector<PoseSample>& out) const;

  /// All samples of a station since the cursor, oldest first, appended to `out`. `missed`: how many of them
  /// were overwritten before this call, because the history is shorter; exactly those are not in `out`.
  ReadOutcome new_poses(int station, PoseCursor& cursor, std::vector<PoseSample>& out,
                        std::uint64_t& missed) const;

  /// New lines with their points, see line_batch.hpp. `batch` is filled from scratch.
  ReadOutcome read_lines(LineCursor& cursor, LineBatch& batch, std::size_t max_points = 1'000'000) const;

  /// The newest picture, unless `out` already holds it (nothing).
  ReadOutcome picture(Picture& out) const;

  std::vector<CounterValue> counters() const;
  std::vector<LatencyFigures> latencies() const;
  /// Measured rate of a station over its history, of the camera over the last pictures.
  RateFigures pose_rate(int station) const;
  RateFigures frame_rate() const;

 private:
  struct Parts;
  class LineCopier;
  explicit SegmentReader(std::unique_ptr<Parts> parts);
  bool news_soon(Topic topics);
  std::unique_ptr<Parts> parts_;
};

}  // namespace linescope
