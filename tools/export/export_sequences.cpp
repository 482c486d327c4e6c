#include <fmt/format.h>

#include <array>
#include <limits>

#include "acquire/record/recorded_camera.hpp"
#include "acquire/record/recorded_tracker.hpp"
#include "acquire/record/recording.hpp"
#include "acquire/tracker/pose_history.hpp"
#include "tools/export/export_recording.hpp"
#include "tools/export/sequence_file.hpp"
#include "tools/export/tool_transforms.hpp"

namespace linescope {
namespace {

namespace fs = std::filesystem;

/// Calls `use` for every good item of a source; damage is counted, anything else ends it.
template <class Item, class Next, class Use>
Result<void> for_each(Next next, ExportReport& report, Use use) {
  for (Item item;;) {
    const Result<Pull> pull = next(item);
    if (!pull && pull.error().code != ErrorCode::unreadable) return tl::unexpected(pull.error());
    if (!pull) {
      ++report.damaged;
      continue;
    }
    if (*pull == Pull::end) return {};
    use(item);
  }
}

ToolTransforms transforms_of(const RecordingInfo& info) {
  return {info.calibration, info.endoscope_station >= 0, info.object_station >= 0,
          info.harvester_station >= 0};
}

bool any_invalid(const SequenceFrame& frame) {
  for (const SequenceTransform& transform : frame.transforms) {
    if (!transform.valid) return true;
  }
  return false;
}

/// Poses at rising times, fed from the recorded samples as far as needed.
class PosesInTime {
 public:
  PosesInTime(const fs::path& folder, ExportReport& report) : tracker_(folder), report_(report) {}
  Result<void> start() { return tracker_.start(); }

  SensorPose at(int station, Nanoseconds time) {
    if (station < 0) return {};
    read_until(time + PoseHistoryOptions{}.longest_gap);
    const PoseAnswer answer = history_.pose_at(station, time);
    return {answer.ok(), answer.world_from_sensor};
  }

 private:
  void read_until(Nanoseconds time) {
    PoseSample sample;
    while (!through_ && newest_ <= time) {
      const auto pull = tracker_.next(sample);
      if (!pull) {
        ++report_.damaged;
        through_ = pull.error().code != ErrorCode::unreadable;
      } else if (*pull == Pull::end) {
        through_ = true;
      } else {
        history_.add(sample);
        newest_ = sample.time;
      }
    }
  }

  RecordedTracker tracker_;
  ExportReport& report_;
  PoseHistory history_;
  Nanoseconds newest_ = std::numeric_limits<Nanoseconds>::min();
  bool through_ = false;
};

SequenceFrame frame_of(const PictureHead& head, const RecordingInfo& info, const ToolTransforms& tools,
                       PosesInTime& poses) {
  SequenceFrame frame;
  frame.time = head.time - info.calibration.camera_latency;
  frame.raw_time = head.time;
  frame.number = head.index;
  frame.has_picture = true;
  frame.transforms =
      tools.at(poses.at(info.endoscope_station, frame.time), poses.at(info.object_station, frame.time),
               poses.at(info.harvester_station, frame.time));
  return frame;
}

/// The samples of one tracker cycle: same frame count, or same time for trackers without one.
struct Cycle {
  Nanoseconds time = 0;
  Nanoseconds arrival = 0;
  std::uint32_t number = 0;
  std::array<SensorPose, kMaxStations> poses{};
  bool started = false;

  bool takes(const PoseSample& sample) const {
    return started && sample.frame_count == number && sample.time == time;
  }
  void begin(const PoseSample& sample) {
    *this = {sample.time, sample.arrival != 0 ? sample.arrival : sample.time, sample.frame_count, {}, true};
  }
  void take(const PoseSample& sample) {
    poses[sample.station] = {usable(sample.state), sample.world_from_sensor};
  }
  SensorPose of(int station) const {
    return station < 0 ? SensorPose{} : poses[static_cast<std::size_t>(station)];
  }
};

SequenceFrame frame_of(const Cycle& cycle, const RecordingInfo& info, const ToolTransforms& tools) {
  SequenceFrame frame;
  frame.time = cycle.time;
  frame.raw_time = cycle.arrival;
  frame.number = cycle.number;
  frame.transforms = tools.at(cycle.of(info.endoscope_station), cycle.of(info.object_station),
                              cycle.of(info.harvester_station));
  return frame;
}

Result<PictureHead> first_picture(const fs::path& folder) {
  RecordedCamera camera(folder);
  if (auto started = camera.start(); !started) return tl::unexpected(started.error());
  for (PictureHead head;;) {
    const auto pull = camera.next_head(head);
    if (pull && *pull == Pull::item) return head;
    if (pull || pull.error().code != ErrorCode::unreadable) break;
  }
  return fail(
      ErrorCode::too_few,
      fmt::format("recording {} holds no picture; --tracker exports the poses alone", folder.string()));
}

/// First run: the frames' fields. Pictures of another size are left out, here as in the second run.
Result<void> write_frames(const Recording& recording, const PictureHead& first, SequenceFile& file,
                          ExportReport& report) {
  RecordedCamera camera(recording.folder);
  PosesInTime poses(recording.folder, report);
  if (auto started = camera.start().and_then([&] { return poses.start(); }); !started) return started;
  const ToolTransforms tools = transforms_of(recording.info);
  return for_each<PictureHead>([&](PictureHead& h) { return camera.next_head(h); }, report,
                               [&](const PictureHead& head) {
                                 if (head.width != first.width || head.height != first.height) {
                                   ++report.other_size;
                                   return;
                                 }
                                 const SequenceFrame frame = frame_of(head, recording.info, tools, poses);
                                 report.without_pose += any_invalid(frame) ? 1 : 0;
                                 file.add_frame(frame);
                               });
}

/// Second run: the pixels.
Result<void> write_pixels(const Recording& recording, const PictureHead& first, SequenceFile& file) {
  RecordedCamera camera(recording.folder);
  if (auto started = camera.start(); !started) return started;
  ExportReport counted_before;
  return for_each<Frame>([&](Frame& f) { return camera.next(f); }, counted_before,
                         [&](const Frame& frame) {
                           if (frame.bgr.cols == first.width && frame.bgr.rows == first.height)
                             file.add_picture(frame.bgr);
                         });
}

}  // namespace

Result<ExportReport> export_pictures_sequence(const fs::path& folder, const fs::path& file) {
  const auto recording = open_recording(folder);
  if (!recording) return tl::unexpected(recording.error());
  const auto first = first_picture(folder);
  if (!first) return tl::unexpected(first.error());
  auto sequence = SequenceFile::create(file, first->width, first->height, true);
  if (!sequence) return tl::unexpected(sequence.error());
  ExportReport report;
  report.remark = recording->remark;
  if (auto frames = write_frames(*recording, *first, *sequence, report); !frames)
    return tl::unexpected(frames.error());
  sequence->end_frames();
  if (auto pixels = write_pixels(*recording, *first, *sequence); !pixels)
    return tl::unexpected(pixels.error());
  report.written = sequence->frames();
  return sequence->close().map([&report] { return report; });
}

Result<ExportReport> export_tracker_sequence(const fs::path& folder, const fs::path& file) {
  const auto recording = open_recording(folder);
  if (!recording) return tl::unexpected(recording.error());
  RecordedTracker tracker(folder);
  if (auto started = tracker.start(); !started) return tl::unexpected(started.error());
  auto sequence = SequenceFile::create(file, 1, 1, false);
  if (!sequence) return tl::unexpected(sequence.error());
  ExportReport report;
  report.remark = recording->remark;
  const ToolTransforms tools = transforms_of(recording->info);
  Cycle cycle;
  const auto finish_cycle = [&] {
    if (!cycle.started) return;
    const SequenceFrame frame = frame_of(cycle, recording->info, tools);
    report.without_pose += any_invalid(frame) ? 1 : 0;
    sequence->add_frame(frame);
  };
  const auto read = for_each<PoseSample>([&](PoseSample& s) { return tracker.next(s); }, report,
                                         [&](const PoseSample& s) {
                                           if (!cycle.takes(s)) {
                                             finish_cycle();
                                             cycle.begin(s);
                                           }
                                           cycle.take(s);
                                         });
  if (!read) return tl::unexpected(read.error());
  finish_cycle();
  sequence->end_frames();
  for (std::uint64_t i = 0; i < sequence->frames(); ++i) sequence->add_picture({});
  report.written = sequence->frames();
  return sequence->close().map([&report] { return report; });
}

}  // namespace linescope
