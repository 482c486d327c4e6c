#include "tools/calibrate/pivot_fit.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "common/units.hpp"
#include "tools/calibrate/blocked_fit.hpp"
#include "tools/calibrate/verdict.hpp"

namespace linescope::calibrate {
namespace {

using Eigen::Matrix3d;

constexpr double kNotMovedDeg = 3;

std::vector<TripleEquation> equations_of(const ToolPoses& poses) {
  std::vector<TripleEquation> equations;
  for (const TimedToolPose& pose : poses) {
    Eigen::Matrix<double, 3, 6> a;
    a << pose.fixture_from_tool.rotation().toRotationMatrix(), -Matrix3d::Identity();
    equations.push_back({a, -pose.fixture_from_tool.translation()});
  }
  return equations;
}

Matrix3d mean_rotation(const ToolPoses& poses) {
  Matrix3d sum = Matrix3d::Zero();
  for (const TimedToolPose& pose : poses) sum += pose.fixture_from_tool.rotation().toRotationMatrix();
  return sum / static_cast<double>(poses.size());
}

/// I - MT M has, along every direction of the tool, the mean square sine by which that direction swayed; the
/// least of them is what is known of the tip along the tool.
double swing_deg_of(const Matrix3d& mean) {
  const Matrix3d sway = Matrix3d::Identity() - mean.transpose() * mean;
  const double least = Eigen::SelfAdjointEigenSolver<Matrix3d>(sway).eigenvalues()(0);
  return degrees_from_radians(std::asin(std::sqrt(std::clamp(least, 0.0, 1.0))));
}

double turned_deg_of(const ToolPoses& poses) {
  double most = 0;
  const Eigen::Quaterniond first = poses.front().fixture_from_tool.rotation();
  for (const TimedToolPose& pose : poses)
    most = std::max(most, first.angularDistance(pose.fixture_from_tool.rotation()));
  return degrees_from_radians(most);
}

tl::unexpected<Error> too_little(double turned, double swing, double least) {
  if (turned < kNotMovedDeg) {
    return tl::unexpected(
        refusal(Refusal::too_little_variation,
                fmt::format("the tool was not moved (it turned by {:.1f} deg)", turned),
                "Rest the tip in a divot and swing the handle to all sides, by 30 deg or more"));
  }
  return tl::unexpected(
      refusal(Refusal::too_little_variation,
              fmt::format("the tool swung by {:.1f} deg RMS about its second axis, at least {:g} are needed",
                          swing, least),
              "Swing the handle not only to and fro but also from side to side, by 30 deg or more"));
}

}  // namespace

Result<void> validate(const PivotOptions& o) {
  if (o.least_poses >= 10 && o.least_poses <= 1000000 && o.least_swing_deg >= 1 && o.least_swing_deg <= 90 &&
      o.most_rms_mm >= 0.01 && o.most_rms_mm <= 100 && o.outlier_sigmas >= 3 && o.outlier_sigmas <= 100)
    return {};
  return fail(
      ErrorCode::invalid,
      "pivoting needs 10 to 1000000 poses, a swing of 1 to 90 deg, an error limit of 0.01 to 100 mm and an "
      "outlier limit of 3 to 100 standard deviations");
}

Result<PivotFit> fit_pivot(const ToolPoses& poses, const PivotOptions& options) {
  if (auto ok = enough_poses(
          poses, options.least_poses,
          "Keep its sensor connected and within the tracker's range, and swing it for some seconds");
      !ok)
    return tl::unexpected(ok.error());
  PivotFit result;
  result.turned_deg = turned_deg_of(poses);
  result.swing_deg = swing_deg_of(mean_rotation(poses));
  if (result.swing_deg < options.least_swing_deg)
    return too_little(result.turned_deg, result.swing_deg, options.least_swing_deg);
  const auto equations = equations_of(poses);
  result.used.assign(poses.size(), true);
  const auto fit = robust_blocked_fit(equations, result.used, options.outlier_sigmas);
  if (!fit) return too_little(result.turned_deg, result.swing_deg, options.least_swing_deg);
  result.tip = fit->x.head<3>();
  result.divot = fit->x.tail<3>();
  result.tip_covariance = fit->covariance.topLeftCorner<3, 3>();
  result.residual_mm = fit->residual;
  result.held_out_mm = held_out_rms(equations, result.used);
  for (const auto& r : fit->residuals) result.error.push_back(r.norm());
  return result;
}

Result<void> above_limit(const PivotFit& fit, const PivotOptions& options) {
  const double worst = std::max(fit.residual_mm, fit.held_out_mm);
  if (worst <= options.most_rms_mm) return {};
  return tl::unexpected(
      refusal(Refusal::error_above_limit,
              fmt::format("the tip wanders by {:.2f} mm RMS about the divot, the limit is {:g}", worst,
                          options.most_rms_mm),
              "Use a divot that holds the tip, keep the sensor fixed to the tool and metal away from the "
              "transmitter"));
}

}  // namespace linescope::calibrate
