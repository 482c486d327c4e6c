#include <fmt/format.h>
#include <fmt/ostream.h>

#include <cmath>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <system_error>

#include "acquire/record/recorded_camera.hpp"
#include "acquire/record/recorded_tracker.hpp"
#include "acquire/record/recording.hpp"
#include "tools/export/export_recording.hpp"
#include "tools/export/seconds_text.hpp"

namespace linescope {
namespace {

namespace fs = std::filesystem;

Result<std::ofstream> created(const fs::path& file) {
  std::ofstream stream(file, std::ios::trunc);
  if (stream) return stream;
  return fail(ErrorCode::permission,
              fmt::format("{} cannot be written; check the folder and its permissions", file.string()));
}

Result<ExportReport> finished(std::ofstream& stream, const fs::path& file, ExportReport report) {
  stream.close();
  if (stream) return report;
  return fail(ErrorCode::full,
              fmt::format("{} could not be written completely; is the disk full?", file.string()));
}

void write_row(std::ofstream& out, const PoseSample& s, bool with_distortion) {
  const Eigen::Vector3d& t = s.world_from_sensor.translation();
  const Eigen::Quaterniond& q = s.world_from_sensor.rotation();
  fmt::print(out, "{},{},{},{},{},{},{},{},{},{},{},{}", seconds_text(s.time), s.station + 1, t.x(), t.y(),
             t.z(), q.w(), q.x(), q.y(), q.z(), name(s.state), s.frame_count, seconds_text(s.arrival));
  if (with_distortion) fmt::print(out, ",{}", s.distortion);
  out << '\n';
}

/// Calls `use` for every good sample. Damage is counted; anything else ends it.
template <class Use>
Result<void> for_each_sample(const fs::path& folder, ExportReport& report, Use use) {
  RecordedTracker tracker(folder);
  if (auto started = tracker.start(); !started) return started;
  for (PoseSample sample;;) {
    const auto pull = tracker.next(sample);
    if (!pull && pull.error().code != ErrorCode::unreadable) return tl::unexpected(pull.error());
    if (pull && *pull == Pull::end) return {};
    if (pull) use(sample);
    report.damaged += pull ? 0 : 1;
  }
}

}  // namespace

Result<ExportReport> export_poses_csv(const fs::path& folder, const fs::path& file) {
  const auto recording = open_recording(folder);
  if (!recording) return tl::unexpected(recording.error());
  ExportReport ignored, report;
  bool with_distortion = true;  // the column has no word for "unknown": all of it or none
  const auto looked = for_each_sample(folder, ignored, [&](const PoseSample& sample) {
    with_distortion = with_distortion && std::isfinite(sample.distortion);
  });
  if (!looked) return tl::unexpected(looked.error());
  auto out = created(file);
  if (!out) return tl::unexpected(out.error());
  *out << "time_s,station,x_mm,y_mm,z_mm,qw,qx,qy,qz,state,frame_count,arrival_s"
       << (with_distortion ? ",distortion\n" : "\n");
  report.remark = recording->remark;
  const auto written = for_each_sample(folder, report, [&](const PoseSample& sample) {
    ++report.written;
    report.without_pose += usable(sample.state) ? 0 : 1;
    write_row(*out, sample, with_distortion);
  });
  if (!written) return tl::unexpected(written.error());
  return finished(*out, file, report);
}

Result<ExportReport> export_pictures(const fs::path& folder, const fs::path& target) {
  const auto recording = open_recording(folder);
  if (!recording) return tl::unexpected(recording.error());
  std::error_code error;
  fs::create_directories(target, error);
  auto out = created(target / "pictures.csv");
  if (!out) return tl::unexpected(out.error());
  *out << "frame,number,time_s,source_name\n";
  RecordedCamera camera(folder);
  if (auto started = camera.start(); !started) return tl::unexpected(started.error());
  ExportReport report;
  report.remark = recording->remark;
  Frame frame;
  for (;;) {
    const auto pull = camera.next(frame);
    if (!pull && pull.error().code != ErrorCode::unreadable) return tl::unexpected(pull.error());
    if (pull && *pull == Pull::end) break;
    if (!pull) {
      ++report.damaged;
      continue;
    }
    const std::string name = fmt::format("{:06}.png", report.written++);
    if (!cv::imwrite((target / name).string(), frame.bgr)) {
      return fail(ErrorCode::full,
                  fmt::format("{} cannot be written; is the disk full?", (target / name).string()));
    }
    fmt::print(*out, "{},{},{},{}\n", name, frame.index, seconds_text(frame.time), frame.name);
  }
  return finished(*out, target / "pictures.csv", report);
}

Result<ExportReport> export_events(const fs::path& folder, const fs::path& file) {
  const auto recording = open_recording(folder);
  if (!recording) return tl::unexpected(recording.error());
  const auto events = read_events(folder);
  if (!events) return tl::unexpected(events.error());
  auto out = created(file);
  if (!out) return tl::unexpected(out.error());
  for (const RecordedEvent& event : *events)
    fmt::print(*out, "{} {}\n", seconds_text(event.time), event.text);
  ExportReport report;
  report.written = events->size();
  report.remark = recording->remark;
  return finished(*out, file, report);
}

}  // namespace linescope
