#include "tools/calibrate/harvester_step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/units.hpp"
#include "tools/calibrate/tool_plots.hpp"
#include "tools/calibrate/turn_correlation.hpp"

namespace linescope::calibrate {
namespace {

using Eigen::Vector3d;

std::string text_of(const Vector3d& v) {
  return fmt::format("{:.4f} {:.4f} {:.4f}", v.x(), v.y(), v.z());
}

std::string put_tip(Calibration& calibration, const Vector3d& tip) {
  const std::string previous = "tip " + text_of(calibration.harvester.tip);
  calibration.harvester.tip = tip;
  // The axis may have come first, when nobody knew which of its ends is the tip's.
  calibration.harvester.axis = oriented_axis(calibration.harvester.axis, tip, calibration.harvester.axis);
  return previous;
}

std::string put_axis(Calibration& calibration, const Vector3d& axis) {
  const std::string previous = "axis " + text_of(calibration.harvester.axis);
  calibration.harvester.axis = oriented_axis(axis, calibration.harvester.tip, calibration.harvester.axis);
  return previous;
}

void add_tip(Quality& quality, const Vector3d& tip, const Vector3d& deviation) {
  for (int k = 0; k < 3; ++k)
    quality.parameters.push_back({fmt::format("tip {}", "xyz"[k]), tip[k], deviation[k], "mm"});
}

void add_axis(Quality& quality, const Vector3d& axis, double deviation_rad) {
  for (int k = 0; k < 3; ++k) {
    const double across = std::sqrt(std::max(0.0, 1 - axis[k] * axis[k]));
    quality.parameters.push_back({fmt::format("axis {}", "xyz"[k]), axis[k], across * deviation_rad, ""});
  }
  quality.parameters.push_back({"direction of the axis", 0, degrees_from_radians(deviation_rad), "deg"});
}

/// Runs of neighbouring poses that the fit left out, one entry each.
void add_outliers(Quality& quality, const ToolPoses& poses, const std::vector<bool>& used,
                  const std::vector<double>& error, const char* unit, double scale) {
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (used[i]) continue;
    const std::size_t first = i;
    double worst = 0;
    for (; i < used.size() && !used[i]; ++i) worst = std::max(worst, error[i]);
    const double from = seconds_from(poses[first].time - poses.front().time);
    quality.left_out.push_back({fmt::format("{} poses from {:.2f} s", i - first, from),
                                fmt::format("outlier: {:.2f} {} from the fit", scale * worst, unit)});
  }
}

Quality quality_of(const HeldPoses& held, const std::vector<bool>& used, const char* unit) {
  Quality quality;
  quality.offered = held.offered;
  quality.used = static_cast<std::size_t>(std::count(used.begin(), used.end(), true));
  quality.left_out = held.left_out;
  quality.unit = unit;
  quality.held_out_count = quality.used;
  return quality;
}

/// Samples without a good pose, one entry for each run of them.
void leave_out(HeldPoses& held, std::size_t run, Nanoseconds since) {
  if (run == 0) return;
  held.left_out.push_back({fmt::format("{} samples from {:.2f} s", run, seconds_from(since)),
                           "no good pose: sensor hidden, out of range, or the object's sensor lost"});
}

}  // namespace

HeldPoses held_poses(const Session& session, HeldBy held_by) {
  HeldPoses held;
  if (session.stations.harvester < 0) return held;
  const auto& samples = session.poses.at(static_cast<std::size_t>(session.stations.harvester));
  const bool by_object = held_by == HeldBy::object && session.stations.object >= 0;
  const PoseTrack object(by_object ? session.poses.at(static_cast<std::size_t>(session.stations.object))
                                   : std::vector<PoseSample>{});
  std::size_t run = 0;
  Nanoseconds since = 0;
  for (const PoseSample& sample : samples) {
    ++held.offered;
    const auto fixture = by_object ? object.at(sample.time) : Rigid<World, Sensor>();
    if (!usable(sample.state) || !fixture || (held_by == HeldBy::object && !by_object)) {
      if (run++ == 0) since = sample.time - samples.front().time;
      continue;
    }
    leave_out(held, run, since);
    run = 0;
    const auto fixture_from_tool =
        renamed<Fixture, World>(fixture->inverse()) * renamed<World, Harvester>(sample.world_from_sensor);
    held.poses.push_back({sample.time, fixture_from_tool});
  }
  leave_out(held, run, since);
  return held;
}

void HarvesterStep::declare(ConfigSchema& schema) {
  HarvesterOptions& o = options_;
  schema.section("harvester", "Tip and axis of the harvester.");
  schema.choice(
      "harvester.motion", o.motion,
      {{"pivot", ToolMotion::pivot}, {"spin", ToolMotion::spin}, {"block", ToolMotion::block}},
      "What was done: tip in a divot, tool turned in a bushing, or tool in the hole of a known block.");
  schema.choice("harvester.held_by", o.held_by, {{"world", HeldBy::world}, {"object", HeldBy::object}},
                "Divot, bushing or block are at rest, or fixed to the object's sensor.");
  schema.integer("harvester.least_poses", o.pivot.least_poses, {.min = 10, .max = 1e6}, "Good poses needed.");
  schema.integer("harvester.most_poses", o.most_poses, {.min = 0, .max = 1e6},
                 "Enough poses, good or not; 0: until --seconds are over or the recording ends.");
  schema.number("harvester.least_swing_deg", o.pivot.least_swing_deg, {.unit = "deg", .min = 1, .max = 90},
                "Pivoting: RMS swing in its lesser direction.");
  schema.number("harvester.most_rms_mm", o.pivot.most_rms_mm, {.unit = "mm", .min = 0.01, .max = 100},
                "Pivoting: limit of the tip's RMS distance from the divot.");
  schema.number("harvester.least_spin_deg", o.spin.least_spin_deg, {.unit = "deg", .min = 5, .max = 180},
                "Spinning: RMS turn about the axis.");
  schema.number("harvester.most_wobble_deg", o.spin.most_wobble_deg, {.unit = "deg", .min = 0.01, .max = 20},
                "Spinning: limit of the axis's RMS wobble.");
  schema.numbers("harvester.block_tip_mm", o.block_tip, {.unit = "mm"}, {.min_items = 3, .max_items = 3},
                 "Block: where the tip stands, in the frame of what holds the block.");
  schema.numbers("harvester.block_axis", o.block_axis, {}, {.min_items = 3, .max_items = 3},
                 "Block: from the tip to the handle, in the same frame.");
  schema.number("harvester.block_rms_mm", o.block_rms_mm, {.unit = "mm", .min = 0.01, .max = 100},
                "Block: limit of the tip's RMS scatter.");
  schema.number("harvester.block_wobble_deg", o.block_wobble_deg, {.unit = "deg", .min = 0.01, .max = 20},
                "Block: limit of the axis's RMS scatter.");
}

BlockOptions HarvesterStep::block() const {
  BlockOptions b;
  b.tip = Vector3d(options_.block_tip[0], options_.block_tip[1], options_.block_tip[2]);
  b.axis = Vector3d(options_.block_axis[0], options_.block_axis[1], options_.block_axis[2]);
  b.least_poses = options_.pivot.least_poses;
  b.most_rms_mm = options_.block_rms_mm;
  b.most_wobble_deg = options_.block_wobble_deg;
  return b;
}

Result<void> HarvesterStep::validate() const {
  if (options_.block_tip.size() != 3 || options_.block_axis.size() != 3)
    return fail(ErrorCode::invalid,
                "harvester.block_tip_mm and harvester.block_axis need three numbers each");
  if (auto ok = calibrate::validate(options_.pivot); !ok) return ok;
  if (auto ok = calibrate::validate(options_.spin); !ok) return ok;
  return calibrate::validate(block());
}

CollectOptions HarvesterStep::wants(const BoardOptions&) const {
  CollectOptions wanted;
  wanted.poses_only = true;
  wanted.most_poses = static_cast<std::size_t>(options_.most_poses);
  return wanted;
}

std::string HarvesterStep::coverage(const Session& so_far, const BoardOptions&) const {
  const HeldPoses held = held_poses(so_far, options_.held_by);
  if (held.poses.empty()) return "no good pose of the harvester yet";
  double most = 0;
  const auto& first = held.poses.front().fixture_from_tool.rotation();
  for (const TimedToolPose& pose : held.poses)
    most = std::max(most, first.angularDistance(pose.fixture_from_tool.rotation()));
  return fmt::format("{} of {} poses good, turned by up to {:.0f} deg", held.poses.size(), held.offered,
                     degrees_from_radians(most));
}

Result<Outcome> HarvesterStep::run(const Session& session, const BoardOptions&,
                                   const Calibration& before) const {
  const HeldPoses held = held_poses(session, options_.held_by);
  switch (options_.motion) {
    case ToolMotion::pivot:
      return pivot(held, before);
    case ToolMotion::spin:
      return spin(held, before);
    case ToolMotion::block:
      return known_block(held);
  }
  return fail(ErrorCode::internal, "unknown motion of the harvester");
}

Result<Outcome> HarvesterStep::pivot(const HeldPoses& held, const Calibration& before) const {
  const auto fit = fit_pivot(held.poses, options_.pivot);
  if (!fit) return tl::unexpected(fit.error());
  Outcome outcome;
  outcome.method = "pivot: linear least squares of tip and divot, robust, deviations from blocks of poses";
  Quality& q = outcome.quality = quality_of(held, fit->used, "mm");
  add_outliers(q, held.poses, fit->used, fit->error, "mm", 1);
  q.residual = fit->residual_mm;
  q.held_out = fit->held_out_mm;
  add_tip(q, fit->tip, fit->tip_covariance.diagonal().cwiseSqrt());
  q.spread = {{"swing in its lesser direction, RMS", fit->swing_deg, kUnknown, "deg"},
              {"largest turn", fit->turned_deg, kUnknown, "deg"}};
  if (auto ok = above_limit(*fit, options_.pivot); !ok) outcome.refused = ok.error();
  outcome.plots.push_back(plot_pivot(held.poses, *fit, before.harvester.tip));
  outcome.put = [tip = fit->tip](Calibration& c) { return put_tip(c, tip); };
  return outcome;
}

Result<Outcome> HarvesterStep::spin(const HeldPoses& held, const Calibration& before) const {
  const auto fit = fit_spin(held.poses, options_.spin);
  if (!fit) return tl::unexpected(fit.error());
  Outcome outcome;
  outcome.method = "spin: the direction that all attitudes leave in place, least squares, robust";
  Quality& q = outcome.quality = quality_of(held, fit->used, "deg");
  add_outliers(q, held.poses, fit->used, fit->error, "deg", degrees_from_radians(1));
  q.residual = degrees_from_radians(fit->residual_rad);
  q.held_out = degrees_from_radians(fit->held_out_rad);
  const Vector3d& tip = before.harvester.tip;
  add_axis(q, oriented_axis(fit->axis, tip, before.harvester.axis), fit->axis_deviation_rad);
  q.spread = {{"turn about the axis, RMS", fit->spin_deg, kUnknown, "deg"},
              {"sideways play, RMS", fit->point_residual_mm, kUnknown, "mm"}};
  if (tip.norm() > 1e-6)
    q.spread.push_back(
        {"the tip known so far lies beside this axis", tip_beside_axis(*fit, tip), kUnknown, "mm"});
  else
    q.remarks.push_back(
        "The tip is not known yet: which end of the axis is the tip's is settled by pivoting.");
  if (auto ok = above_limit(*fit, options_.spin); !ok) outcome.refused = ok.error();
  outcome.plots.push_back(plot_spin(held.poses, *fit));
  outcome.put = [axis = fit->axis](Calibration& c) { return put_axis(c, axis); };
  return outcome;
}

Result<Outcome> HarvesterStep::known_block(const HeldPoses& held) const {
  const auto fit = fit_block(held.poses, block());
  if (!fit) return tl::unexpected(fit.error());
  Outcome outcome;
  outcome.method = "block: mean of tip and axis over the poses in a hole of known place";
  Quality& q = outcome.quality = quality_of(held, std::vector<bool>(held.poses.size(), true), "mm");
  q.residual = fit->residual_mm;
  q.held_out = fit->held_out_mm;
  add_tip(q, fit->tip, fit->tip_deviation);
  add_axis(q, fit->axis, fit->axis_deviation_rad);
  q.spread = {{"scatter of the axis, RMS", degrees_from_radians(fit->residual_rad), kUnknown, "deg"}};
  if (auto ok = above_limit(*fit, block()); !ok) outcome.refused = ok.error();
  outcome.plots.push_back(plot_block(held.poses, block(), *fit));
  outcome.put = [tip = fit->tip, axis = fit->axis](Calibration& c) {
    const std::string previous = "axis " + text_of(c.harvester.axis) + ", " + put_tip(c, tip);
    c.harvester.axis = axis;
    return previous;
  };
  return outcome;
}

}  // namespace linescope::calibrate
