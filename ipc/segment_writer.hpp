// The one writer of a segment: the daemon. No call after create() allocates, locks or waits.
//
// Threads. Each part of the segment has exactly one writing thread; which thread that is, is the caller's
// choice, but it must always be the same one (or be handed over with a happens-before, as a join gives):
//
//   life     heartbeat (Heartbeat in ipc/heartbeat.hpp does it)
//   state    set_state, publish_configuration, publish_calibration
//   pose     publish_pose, set_sensor_status
//   line     begin_scan, set_scanning, undo_to, publish_line, publish_picture, set_camera_status
//   any      count, record_latency (atomic additions)
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string_view>

#include "common/pose_sample.hpp"
#include "common/result.hpp"
#include "common/surface_point.hpp"
#include "ipc/segment_options.hpp"
#include "ipc/segment_types.hpp"

namespace linescope {

/// What became of a line that was offered.
enum class PublishOutcome {
  stored,
  full,          ///< no room for it; counted as lines_segment_full, points_segment_full
  not_scanning,  ///< counted as lines_not_scanning
  invalid,       ///< no point, or more points than points_per_line; counted as lines_invalid
};
std::string_view name(PublishOutcome outcome);

/// Why a new generation of the scan begins.
enum class ScanCause : std::uint32_t { new_scan = LS_SCAN_NEW, cleared = LS_SCAN_CLEARED };

class SegmentWriter {
 public:
  /// Takes the name and lays out the segment and its control segment, all pages reserved.
  ///  - A living writer of that name: `busy`, "already running, pid N". It is recognised by its heartbeat,
  ///  which takes up
  ///    to 1 s when there is reason to doubt; a process that provably ended is replaced at once.
  ///  - A dead writer's leftovers are replaced; its readers are told.
  ///  - Somebody else's object, or one that is no segment: `permission` or `mismatch`; it is left alone.
  ///  - Not enough room in /dev/shm: `full`, with the size it would need.
  static Result<SegmentWriter> create(const SegmentOptions& options);

  /// Marks the segment as closed, wakes the readers, removes both names (unless a successor has taken them).
  ~SegmentWriter();
  SegmentWriter(SegmentWriter&&) noexcept;
  SegmentWriter& operator=(SegmentWriter&&) noexcept;

  /// I am alive. At least every 50 ms, whatever the devices do. `gone` when somebody has taken over or
  /// removed the name (after a standstill of more than a second): the caller should end.
  Result<void> heartbeat(Nanoseconds now);

  void set_state(DaemonState state, std::string_view reason);

  /// Effective configuration (TOML) or calibration (YAML) for the viewers. False, and counted as
  /// texts_too_long, when it is longer than SegmentOptions::text_bytes: then the former text stays.
  bool publish_configuration(std::string_view toml);
  bool publish_calibration(std::string_view yaml);

  /// Latest pose and history of sample.station (0 .. 7); another station is counted as
  /// tracker_samples_unknown_station.
  void publish_pose(const PoseSample& sample);
  void set_sensor_status(int station, const SensorStatus& status);

  /// Begins the next scan: a new scan id, no lines. Taking lines or not is set_scanning's matter.
  void begin_scan(Nanoseconds now, ScanCause cause = ScanCause::new_scan);
  /// Whether publish_line stores. False after create().
  void set_scanning(bool scanning);
  bool scanning() const;
  /// Keeps the scan's first `lines` lines only (undo of the last sweep). Serial numbers go on. Nothing when
  /// there are not more.
  void undo_to(std::uint32_t lines);
  std::uint32_t lines_in_scan() const;
  std::uint32_t scan_id() const;
  bool full() const;

  /// One line with its points (world, mm; finite: that is the reconstruction's promise and not looked at
  /// here), visible with one store. Every call is counted as lines_offered and
  /// as one of lines_published, lines_segment_full, lines_not_scanning, lines_invalid.
  PublishOutcome publish_line(const ScanLineInfo& info, std::span<const SurfacePoint> points);

  /// The latest picture; `stride` is the distance of two rows of `pixels` in bytes. Samples beyond
  /// picture_samples are left out and counted; a picture larger than picture_bytes is left out and counted
  /// (false), its time is noted all the same.
  bool publish_picture(const PictureInfo& info, const std::byte* pixels, std::size_t stride,
                       std::span<const PictureSample> samples);
  void set_camera_status(const CameraReport& status);

  void count(Counter counter, std::uint64_t n = 1);
  void record_latency(LatencyStage stage, Nanoseconds duration);
  std::uint64_t counted(Counter counter) const;

  std::uint64_t session_id() const;
  const std::string& name() const;

 private:
  struct Parts;
  explicit SegmentWriter(std::unique_ptr<Parts> parts);
  friend class ControlServer;
  PublishOutcome refuse_line(PublishOutcome outcome, Counter why);
  std::unique_ptr<Parts> parts_;
};

}  // namespace linescope
