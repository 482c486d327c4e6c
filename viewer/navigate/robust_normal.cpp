#include "viewer/navigate/robust_normal.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "viewer/navigate/angle_difference.hpp"
#include "viewer/navigate/angle_interval.hpp"

namespace linescope {
namespace {

Eigen::Vector3d normal_of(const Eigen::Vector2d& slope) {
  return Eigen::Vector3d(-slope.x(), -slope.y(), 1).normalized();
}

/// Where a straight line (local frame) meets the surface, by Newton's method from its foot on the tangent
/// plane.
std::optional<Eigen::Vector3d> meet(const Cubic& surface, const Eigen::Vector3d& tip,
                                    const Eigen::Vector3d& axis, double reach) {
  double t = -tip.z() / axis.z();
  for (int round = 0; round < 8; ++round) {
    const Eigen::Vector3d p = tip + t * axis;
    if (!(p.head<2>().norm() < reach)) return std::nullopt;
    const double miss = p.z() - surface.height(p.x(), p.y());
    const double rate = axis.z() - surface.slope(p.x(), p.y()).dot(axis.head<2>());
    if (!(rate > 0.05)) return std::nullopt;
    t -= miss / rate;
    if (std::abs(miss) < 1e-9) break;
  }
  return tip + t * axis;
}

/// Nearest point of the surface: the tip is straight above it along the normal there.
std::optional<Eigen::Vector3d> nearest(const Cubic& surface, const Eigen::Vector3d& tip, double reach) {
  Eigen::Vector2d at = tip.head<2>();
  for (int round = 0; round < 30; ++round) {
    if (!(at.norm() < reach)) return std::nullopt;
    const double above = tip.z() - surface.height(at.x(), at.y());
    const Eigen::Vector2d next = tip.head<2>() + above * surface.slope(at.x(), at.y());
    const Eigen::Vector2d step = next - at;
    at += 0.7 * step;  // damped: the plain step swings when the tip is high above a curved surface
    if (step.norm() < 1e-9) break;
  }
  return Eigen::Vector3d(at.x(), at.y(), surface.height(at.x(), at.y()));
}

class Estimation {
 public:
  Estimation(const LiveIndex& index, const NormalQuery& query, const RobustNormalOptions& options)
      : index_(index), query_(query), options_(options), axis_(query.axis.normalized()) {}

  NormalEstimate run() {
    result_.method = NormalMethod::robust;
    if (!query_.tip.allFinite() || !axis_.allFinite() || !(axis_.norm() > 0.5) ||
        !index_.grid().holds(query_.tip))
      return refuse(NormalReason::bad_query);
    const FoundFoot found = find_foot(index_, query_.tip, axis_, options_.foot);
    if (found.reason != NormalReason::none) return refuse(found.reason);
    fit(PatchFrame(found.foot, found.normal), options_.radius);
    if (result_.reason != NormalReason::none) return result_;
    place();
    return result_;
  }

 private:
  NormalEstimate refuse(NormalReason reason) {
    result_.reason = reason;
    return result_;
  }

  void fit(const PatchFrame& frame, double radius) {
    gather(index_, frame, radius, options_.height, patch_);
    quadric_ = fit_robust_quadric(patch_, options_.robust);
    shrink_to_curvature();
    bend_ << 2 * quadric_.b[3], quadric_.b[4], quadric_.b[4], 2 * quadric_.b[5];
    const Support support = judge_support(patch_, query_.now, options_.support);
    result_.counts = support.counts;
    result_.age = support.counts.points > 0 ? query_.now - support.newest : 0;
    result_.radius_of_fit = patch_.radius;
    result_.reason = support.reason;
    if (support.reason == NormalReason::none && may_be_crease()) result_.reason = NormalReason::too_curved;
    if (result_.reason == NormalReason::none) solution_ = solve_patch(patch_, quadric_, options_.solution);
    if (result_.reason == NormalReason::none && !solution_.solved)
      result_.reason = NormalReason::too_uncertain;
  }

  /// A smaller patch may show a curvature that the larger one smoothed over: until both agree.
  void shrink_to_curvature() {
    constexpr int kMostRounds = 4;
    for (int round = 0; round < kMostRounds; ++round) {
      const double wanted = options_.curvature_reach / std::max(quadric_.curvature(), 1e-6);
      strongly_curved_ = strongly_curved_ || wanted < options_.smallest_radius;
      const double next = std::max(wanted, options_.smallest_radius);
      if (next >= 0.85 * patch_.radius) return;
      shrink(patch_, next);
      quadric_ = fit_robust_quadric(patch_, options_.robust);
    }
  }

  /// Where a quadric hardly fits into the patch, what does not lie on it may be the other side of a crease.
  bool may_be_crease() const { return strongly_curved_ && quadric_.used < options_.agreement * patch_.size; }

  /// Foot, normals and distances on the solved surface.
  void place() {
    const PatchFrame& frame = patch_.frame;
    const Eigen::Vector3d tip = frame.point_in(query_.tip);
    const Eigen::Vector3d axis = frame.direction_in(axis_);
    const auto foot = meet(solution_.surface, tip, axis, patch_.radius);
    if (!foot) {
      result_.reason = NormalReason::axis_misses_surface;
      return;
    }
    const Eigen::Vector3d normal = normal_of(solution_.surface.slope(foot->x(), foot->y()));
    result_.foot = frame.point_out(*foot);
    result_.normal = frame.direction_out(normal);
    result_.depth = (tip - *foot).dot(axis);
    if (const auto near = nearest(solution_.surface, tip, patch_.radius)) {
      const Eigen::Vector3d there = normal_of(solution_.surface.slope(near->x(), near->y()));
      result_.nearest = frame.point_out(*near);
      result_.nearest_normal = frame.direction_out(there);
      result_.distance = (tip - *near).dot(there);
    }
    judge_angle(normal, axis);
  }

  /// Where a part of the patch was seen to be something else, some of that was not seen: growth of the
  /// variance, measured beside flaps with ragged edges.
  double doubt() const {
    const double out = result_.counts.points_rejected, used = result_.counts.points;
    return 1 + 2 * out / std::max(1.0, used + out);
  }

  /// A small patch has few segments, whose scatter is itself uncertain: those that by chance scatter little
  /// would be the ones answered.
  double largest_uncertainty() const {
    constexpr double kEnough = 3;  // mm
    return options_.support.largest_uncertainty * std::min(1.0, patch_.radius / kEnough);
  }

  /// The scan alone cannot be less certain than with the tracker: one cone is mostly enough.
  bool certain_enough(const Eigen::Matrix2d& of_scan) const {
    const double whole = result_.normal_uncertainty;
    if (whole <= std::min(largest_uncertainty(), options_.support.largest_cone)) return true;
    return whole <= options_.support.largest_cone &&
           cone_95({of_scan, solution_.degrees_of_freedom}) <= largest_uncertainty();
  }

  void judge_angle(const Eigen::Vector3d& normal, const Eigen::Vector3d& axis) {
    const Unseen& unseen = options_.unseen;
    const Eigen::Matrix2d of_scan = doubt() * solution_.slope_covariance;
    TiltError error{of_scan + unseen.tip * unseen.tip * bend_ * bend_.transpose(),
                    solution_.degrees_of_freedom};
    error.covariance.diagonal().array() += unseen.surface_tilt * unseen.surface_tilt;
    result_.normal_uncertainty = cone_95(error);
    error.covariance.diagonal().array() += unseen.axis_tilt * unseen.axis_tilt;
    result_.angle = angle_difference(normal, axis);
    const Eigen::Vector2d across = (axis - axis.dot(normal) * normal).head<2>();
    const Eigen::Vector2d tilt =
        across.norm() > 0 ? Eigen::Vector2d(across.normalized() * result_.angle) : across;
    const AngleInterval interval = angle_interval_95(tilt, error);
    result_.angle_low = interval.low;
    result_.angle_high = interval.high;
    if (!certain_enough(of_scan)) result_.reason = NormalReason::too_uncertain;
  }

  const LiveIndex& index_;
  const NormalQuery& query_;
  const RobustNormalOptions& options_;
  Eigen::Vector3d axis_;
  NormalEstimate result_;
  Patch patch_;
  Quadric quadric_;
  Eigen::Matrix2d bend_ = Eigen::Matrix2d::Zero();  ///< change of the slope per move along the surface, 1/mm
  PatchSolution solution_;
  bool strongly_curved_ = false;  ///< a fit asked for a smaller patch than there is
};

}  // namespace

Unseen Unseen::of_field(double position_mm, double rotation_rad) {
  constexpr double kPerAxis = 1 / std::numbers::sqrt3, kTurn = 2 * std::numbers::pi;
  constexpr double kEndoscopeLever = 150, kHarvesterLever = 180, kWavelength = 250;
  const double position = position_mm * kPerAxis, rotation = rotation_rad * kPerAxis;
  // A random wave's slope along one direction of three.
  const double bent = kTurn / kWavelength * kPerAxis * std::hypot(position, kEndoscopeLever * rotation);
  const Unseen clear;
  Unseen unseen;
  unseen.surface_tilt = std::hypot(bent, rotation);
  unseen.axis_tilt = std::hypot(clear.axis_tilt, rotation);
  unseen.tip = std::sqrt(clear.tip * clear.tip + 2 * position * position +
                         std::pow(kEndoscopeLever * rotation, 2) + std::pow(kHarvesterLever * rotation, 2));
  return unseen;
}

Result<void> validate(const RobustNormalOptions& o) {
  if (!(o.smallest_radius >= 0.5 && o.radius >= o.smallest_radius && o.radius <= 20))
    return fail(ErrorCode::invalid,
                fmt::format("normal estimate: patch radii {} and {} mm are not in order within 0.5 to 20 mm",
                            o.smallest_radius, o.radius));
  if (!(o.height > 0))
    return fail(ErrorCode::invalid, "normal estimate: height of the patch must be positive");
  if (!(o.agreement >= 0 && o.agreement <= 1))
    return fail(ErrorCode::invalid, "normal estimate: agreement must be a share between 0 and 1");
  if (!(o.curvature_reach > 0))
    return fail(ErrorCode::invalid, "normal estimate: curvature reach must be positive");
  if (!(o.unseen.surface_tilt >= 0 && o.unseen.axis_tilt >= 0 && o.unseen.tip >= 0))
    return fail(ErrorCode::invalid,
                "normal estimate: standard deviations of tilts and tip must not be negative");
  if (!(o.robust.cut > 0) || !(o.robust.smallest_scale > 0) || !(o.robust.usual_curvature > 0))
    return fail(ErrorCode::invalid, "normal estimate: robust fit needs a positive cut, scale and curvature");
  if (!(o.foot.reach_ahead >= 0 && o.foot.reach_behind >= 0))
    return fail(ErrorCode::invalid, "normal estimate: reaches along the axis must not be negative");
  if (o.support.fewest_points < 6 || o.support.fewest_lines < 3)
    return fail(ErrorCode::invalid,
                "normal estimate: at least 6 points and 3 lines are needed for a curved surface");
  if (!(o.support.largest_uncertainty > 0 && o.support.largest_cone > 0) || o.support.oldest <= 0)
    return fail(ErrorCode::invalid, "normal estimate: limits of uncertainty and age must be positive");
  return {};
}

NormalEstimate robust_normal(const LiveIndex& index, const NormalQuery& query,
                             const RobustNormalOptions& options) {
  return Estimation(index, query, options).run();
}

}  // namespace linescope
