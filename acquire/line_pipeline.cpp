#include "acquire/line_pipeline.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace linescope {
namespace {

/// The counter for a profile (column or row) that gave no point. Profiles without any laser light are not
/// counted: the line simply is not there.
void count_profile(SegmentWriter& writer, NoPoint reason, std::uint64_t n) {
  switch (reason) {
    case NoPoint::no_light:
    case NoPoint::bad_picture:
      return;
    case NoPoint::wrong_colour:
      return writer.count(Counter::points_too_weak, n);
    case NoPoint::too_dim:
      return writer.count(Counter::points_low_snr, n);
    case NoPoint::too_narrow:
      return writer.count(Counter::points_too_weak, n);
    case NoPoint::too_wide:
      return writer.count(Counter::points_too_wide, n);
    case NoPoint::saturated:
      return writer.count(Counter::points_saturated, n);
    case NoPoint::ambiguous:
      return writer.count(Counter::points_ambiguous, n);
    case NoPoint::isolated:
      return writer.count(Counter::points_isolated, n);
    case NoPoint::at_border:
      return writer.count(Counter::points_outside_picture, n);
  }
}

Counter counter_of(NoSurface reason) {
  switch (reason) {
    case NoSurface::outside_lens:
      return Counter::points_outside_picture;
    case NoSurface::behind:
      return Counter::points_no_intersection;
    case NoSurface::too_near:
      return Counter::points_too_near;
    case NoSurface::too_far:
      return Counter::points_too_far;
    case NoSurface::not_finite:
      break;
  }
  return Counter::points_not_finite;
}

Counter counter_of(ToolState state) {
  switch (state) {
    case ToolState::distorted_field:
      return Counter::frames_pose_distorted;
    case ToolState::out_of_view:
      return Counter::frames_pose_out_of_view;
    case ToolState::missing:
      return Counter::frames_pose_missing;
    case ToolState::disconnected:
      return Counter::frames_pose_disconnected;
    case ToolState::never_seen:
      return Counter::frames_pose_never_seen;
    case ToolState::ok:
    case ToolState::stale:
      break;
  }
  return Counter::frames_pose_stale;
}

Counter counter_of(const PoseAnswer& answer) {
  switch (answer.miss) {
    case PoseMiss::never_seen:
      return Counter::frames_pose_never_seen;
    case PoseMiss::too_early:
      return Counter::frames_no_pose_before;
    case PoseMiss::too_late:
      return Counter::frames_no_pose_after;
    case PoseMiss::gap_too_long:
      return Counter::frames_pose_gap_too_long;
    case PoseMiss::state_bad:
    case PoseMiss::none:
      break;
  }
  return counter_of(answer.state);
}

template <class Items, class Value>
float mean_of(const Items& items, Value value) {
  if (items.empty()) return 0;
  double sum = 0;
  for (const auto& item : items) sum += static_cast<double>(value(item));
  return static_cast<float>(sum / static_cast<double>(items.size()));
}

/// Runs `work` and notes how long it took.
template <class Work>
void timed(SegmentWriter& writer, LatencyStage stage, Work work) {
  const Nanoseconds begin = monotonic_now();
  work();
  writer.record_latency(stage, monotonic_now() - begin);
}

}  // namespace

LinePipeline::LinePipeline(const LineExtractorOptions& laser, LineReconstructor reconstructor,
                           const ToolPoseLookup& poses, SegmentWriter& writer)
    : extractor_(laser), reconstructor_(std::move(reconstructor)), poses_(poses), writer_(writer) {
  const CameraModel& camera = reconstructor_.calibration().camera;
  const auto longest = static_cast<std::size_t>(std::max(camera.width, camera.height));
  points_.points.reserve(longest);
  points_.pixels.reserve(longest);
  samples_.reserve(longest);
}

Nanoseconds LinePipeline::instant(const Frame& frame) const {
  return frame.time - reconstructor_.calibration().camera_latency;
}

void LinePipeline::show(const Frame& frame) {
  writer_.count(Counter::frames_received);
  timed(writer_, LatencyStage::extract, [&] { line_ = &extractor_.extract(frame.bgr); });
  count_profiles();
  timed(writer_, LatencyStage::publish_picture, [&] { publish_picture(frame); });
}

void LinePipeline::count_profiles() {
  for (std::size_t i = 0; i < kNoPointReasons; ++i)
    if (line_->no_point[i] > 0) count_profile(writer_, static_cast<NoPoint>(i), line_->no_point[i]);
}

void LinePipeline::publish_picture(const Frame& frame) {
  samples_.clear();
  for (const LineSample& s : line_->samples) samples_.push_back({s.u, s.v, s.peak, s.snr});
  PictureInfo info;
  info.time = frame.time;
  info.frame = frame.index;
  info.width = static_cast<std::uint32_t>(frame.bgr.cols);
  info.height = static_cast<std::uint32_t>(frame.bgr.rows);
  info.format = frame.bgr.channels() == 1 ? PixelFormat::gray8 : PixelFormat::bgr8;
  info.name = frame.name;
  writer_.publish_picture(info, reinterpret_cast<const std::byte*>(frame.bgr.data), frame.bgr.step[0],
                          samples_);
}

void LinePipeline::place(const Frame& frame) {
  if (!writer_.scanning()) return writer_.count(Counter::frames_not_scanning);
  if (line_->samples.empty()) return writer_.count(Counter::frames_line_not_found);
  const ToolPoses poses = poses_.at(instant(frame));
  if (poses.endoscope.state != ToolState::ok) return writer_.count(counter_of(poses.endoscope_answer));
  Result<void> placed;
  timed(writer_, LatencyStage::reconstruct,
        [&] { placed = reconstructor_.reconstruct(*line_, poses.endoscope.world_from_tool, points_); });
  if (!placed) {
    return writer_.count(placed.error().code == ErrorCode::mismatch ? Counter::frames_wrong_size
                                                                    : Counter::points_not_finite);
  }
  for (std::size_t i = 0; i < kNoSurfaceReasons; ++i)
    if (points_.no_surface[i] > 0)
      writer_.count(counter_of(static_cast<NoSurface>(i)), points_.no_surface[i]);
  if (points_.points.empty()) return writer_.count(Counter::frames_no_surface_point);
  timed(writer_, LatencyStage::publish_line, [&] { publish_line(frame, poses); });
  writer_.record_latency(LatencyStage::frame_total, monotonic_now() - frame.time);
}

void LinePipeline::publish_line(const Frame& frame, const ToolPoses& poses) {
  ScanLineInfo info;
  info.time = instant(frame);
  info.frame = frame.index;
  info.endoscope = poses.endoscope;
  info.object = poses.object;
  info.harvester = poses.harvester;
  info.quality = quality(poses.endoscope_answer);
  writer_.publish_line(info, points_.points);
}

LineQuality LinePipeline::quality(const PoseAnswer& endoscope) const {
  LineQuality q;
  q.mean_peak = mean_of(line_->samples, [](const LineSample& s) { return s.peak; });
  q.mean_width = mean_of(line_->samples, [](const LineSample& s) { return s.width; });
  q.mean_snr = line_->mean_snr;
  q.mean_deviation = mean_of(points_.points, [](const SurfacePoint& p) { return p.standard_deviation; });
  q.coverage = static_cast<float>(points_.points.size()) / static_cast<float>(std::max(1, line_->profiles()));
  const auto lit =
      std::accumulate(line_->no_point.begin(), line_->no_point.end(), 0u) - line_->count(NoPoint::no_light);
  q.rejected = lit;
  q.pose_gap = endoscope.gap;
  return q;
}

}  // namespace linescope
