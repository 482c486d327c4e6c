#include "tools/calibrate/spin_fit.hpp"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "common/units.hpp"
#include "tools/calibrate/blocked_fit.hpp"
#include "tools/calibrate/verdict.hpp"

namespace linescope::calibrate {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

using Across = Eigen::Matrix<double, 3, 2>;

Across across(const Vector3d& axis) {
  Across basis;
  basis << axis.unitOrthogonal(), axis.cross(axis.unitOrthogonal());
  return basis;
}

/// The direction that all attitudes leave most nearly in place.
struct Still {
  Vector3d axis;
  double rms_turn = 0;  ///< rad, of the directions across it
};

Still still_direction(const ToolPoses& poses) {
  Matrix3d mean = Matrix3d::Zero();
  for (const TimedToolPose& pose : poses) mean += pose.fixture_from_tool.rotation().toRotationMatrix();
  mean /= static_cast<double>(poses.size());
  const Eigen::JacobiSVD<Matrix3d> svd(mean, Eigen::ComputeFullV);
  // Across the axis the mean shrinks by the mean cosine of the turn; the means of sines only turn it.
  const double shrunk = std::clamp(svd.singularValues()(1), 0.0, 1.0);
  return {svd.matrixV().col(0), std::sqrt(std::max(0.0, 1 - shrunk * shrunk))};
}

double rms_turn_deg(const Still& still) {
  return degrees_from_radians(std::asin(std::min(1.0, still.rms_turn)));
}

/// R (a + T d) = w with the small turn d of the axis and the free direction w.
std::vector<TripleEquation> axis_equations(const ToolPoses& poses, const Vector3d& axis) {
  const Across basis = across(axis);
  std::vector<TripleEquation> equations;
  for (const TimedToolPose& pose : poses) {
    const Matrix3d r = pose.fixture_from_tool.rotation().toRotationMatrix();
    Eigen::Matrix<double, 3, 5> a;
    a << r * basis, -Matrix3d::Identity();
    equations.push_back({a, -(r * axis)});
  }
  return equations;
}

std::vector<TripleEquation> point_equations(const ToolPoses& poses, const Vector3d& axis) {
  const Across basis = across(axis);
  std::vector<TripleEquation> equations;
  for (const TimedToolPose& pose : poses) {
    Eigen::Matrix<double, 3, 5> a;
    a << pose.fixture_from_tool.rotation().toRotationMatrix() * basis, -Matrix3d::Identity();
    equations.push_back({a, -pose.fixture_from_tool.translation()});
  }
  return equations;
}

tl::unexpected<Error> too_little(double spin, double least) {
  return tl::unexpected(refusal(
      Refusal::too_little_variation,
      fmt::format("the tool turned by {:.1f} deg RMS about its axis, at least {:g} are needed", spin, least),
      "Turn the tool about its own axis in a bushing, by half a turn or more to and fro"));
}

}  // namespace

Result<void> validate(const SpinOptions& o) {
  if (o.least_poses >= 10 && o.least_poses <= 1000000 && o.least_spin_deg >= 5 && o.least_spin_deg <= 180 &&
      o.most_wobble_deg >= 0.01 && o.most_wobble_deg <= 20 && o.outlier_sigmas >= 3 &&
      o.outlier_sigmas <= 100)
    return {};
  return fail(
      ErrorCode::invalid,
      "spinning needs 10 to 1000000 poses, a turn of 5 to 180 deg, a wobble limit of 0.01 to 20 deg and an "
      "outlier limit of 3 to 100 standard deviations");
}

Result<SpinFit> fit_spin(const ToolPoses& poses, const SpinOptions& options) {
  if (auto ok = enough_poses(
          poses, options.least_poses,
          "Keep its sensor connected and within the tracker's range, and turn it for some seconds");
      !ok)
    return tl::unexpected(ok.error());
  SpinFit result;
  const Still still = still_direction(poses);
  result.spin_deg = rms_turn_deg(still);
  if (result.spin_deg < options.least_spin_deg) return too_little(result.spin_deg, options.least_spin_deg);
  const auto equations = axis_equations(poses, still.axis);
  result.used.assign(poses.size(), true);
  const auto fit = robust_blocked_fit(equations, result.used, options.outlier_sigmas);
  if (!fit) return too_little(result.spin_deg, options.least_spin_deg);
  result.axis = (still.axis + across(still.axis) * fit->x.head<2>()).normalized();
  result.axis_deviation_rad = std::sqrt(0.5 * fit->covariance.topLeftCorner<2, 2>().trace());
  result.residual_rad = fit->residual;
  result.held_out_rad = held_out_rms(equations, result.used);
  for (const auto& r : fit->residuals) result.error.push_back(r.norm());
  if (const auto place = blocked_fit(point_equations(poses, result.axis), result.used)) {
    result.point = across(result.axis) * place->x.head<2>();
    result.point_residual_mm = place->residual;
  }
  return result;
}

Result<void> above_limit(const SpinFit& fit, const SpinOptions& options) {
  const double worst = degrees_from_radians(std::max(fit.residual_rad, fit.held_out_rad));
  if (worst <= options.most_wobble_deg) return {};
  return tl::unexpected(refusal(
      Refusal::error_above_limit,
      fmt::format("the axis wobbles by {:.2f} deg RMS, the limit is {:g}", worst, options.most_wobble_deg),
      "Turn the tool in a bushing or V-block that holds its axis, and do not tilt it"));
}

Vector3d oriented_axis(const Vector3d& axis, const Vector3d& tip, const Vector3d& previous) {
  const double side = tip.norm() > 1e-6 ? -axis.dot(tip) : axis.dot(previous);
  return side < 0 ? Vector3d(-axis) : axis;
}

double tip_beside_axis(const SpinFit& fit, const Vector3d& tip) {
  return fit.axis.cross(tip - fit.point).norm();
}

}  // namespace linescope::calibrate
