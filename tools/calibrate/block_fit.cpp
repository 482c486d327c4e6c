#include "tools/calibrate/block_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/units.hpp"
#include "tools/calibrate/blocked_fit.hpp"
#include "tools/calibrate/verdict.hpp"

namespace linescope::calibrate {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

std::vector<TripleEquation> mean_of(const std::vector<Vector3d>& values) {
  std::vector<TripleEquation> equations;
  for (const Vector3d& value : values) equations.push_back({Matrix3d::Identity(), value});
  return equations;
}

}  // namespace

Result<void> validate(const BlockOptions& o) {
  if (o.tip.allFinite() && o.axis.allFinite() && o.axis.norm() > 1e-6 && o.least_poses >= 10 &&
      o.least_poses <= 1000000 && o.most_rms_mm >= 0.01 && o.most_rms_mm <= 100 &&
      o.most_wobble_deg >= 0.01 && o.most_wobble_deg <= 20)
    return {};
  return fail(
      ErrorCode::invalid,
      "a block needs the place of the tip (mm), an axis that is not 0, 0, 0, 10 to 1000000 poses and limits "
      "of 0.01 to 100 mm and 0.01 to 20 deg");
}

Result<BlockFit> fit_block(const ToolPoses& poses, const BlockOptions& options) {
  if (auto ok = enough_poses(
          poses, options.least_poses,
          "Keep its sensor and the block's within the tracker's range, and let it stand for some seconds");
      !ok)
    return tl::unexpected(ok.error());
  std::vector<Vector3d> tips, axes;
  for (const TimedToolPose& pose : poses) {
    const auto tool_from_fixture = pose.fixture_from_tool.inverse();
    tips.push_back(tool_from_fixture * options.tip);
    axes.push_back(tool_from_fixture.rotate(options.axis.normalized()));
  }
  const auto tip_equations = mean_of(tips), axis_equations = mean_of(axes);
  const std::vector<bool> all(poses.size(), true);
  const auto tip = blocked_fit(tip_equations, all), axis = blocked_fit(axis_equations, all);
  BlockFit fit;
  fit.tip = tip->x;
  fit.axis = Vector3d(axis->x).normalized();
  fit.tip_deviation = tip->covariance.diagonal().cwiseSqrt();
  fit.axis_deviation_rad = std::sqrt(0.5 * axis->covariance.trace());
  fit.residual_mm = tip->residual;
  fit.residual_rad = axis->residual;
  fit.held_out_mm = held_out_rms(tip_equations, all);
  fit.held_out_rad = held_out_rms(axis_equations, all);
  return fit;
}

Result<void> above_limit(const BlockFit& fit, const BlockOptions& options) {
  const double mm = std::max(fit.residual_mm, fit.held_out_mm);
  const double deg = degrees_from_radians(std::max(fit.residual_rad, fit.held_out_rad));
  if (mm <= options.most_rms_mm && deg <= options.most_wobble_deg) return {};
  return tl::unexpected(refusal(
      Refusal::error_above_limit,
      fmt::format("the tip wanders by {:.2f} mm and the axis by {:.2f} deg RMS, the limits are {:g} and {:g}",
                  mm, deg, options.most_rms_mm, options.most_wobble_deg),
      "Let the tool stand firmly in the block's hole while the poses are taken"));
}

}  // namespace linescope::calibrate
