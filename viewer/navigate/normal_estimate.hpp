// What goes into a normal estimate and what comes out: plain data, all in the object's frame (sensor 2),
// millimetres.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>

#include "common/surface_point.hpp"
#include "common/time.hpp"

namespace linescope {

/// One laser line as the index takes it. Errors of a line's points are shared (one pose placed them all), so
/// a line, not a point, is the unit that counts as independent.
struct NavigationLine {
  std::uint64_t id = 0;                  ///< running number of the line record; unique within a scan
  Nanoseconds time = 0;                  ///< middle of exposure
  Eigen::Vector3d view{0, 0, -1};        ///< unit, from the endoscope towards the surface
  std::span<const SurfacePoint> points;  ///< any order; standard_deviation <= 0 or NaN means "not known"
};

/// Where the harvester is. Both from its calibration and the poses of one instant, never assumed.
struct NormalQuery {
  Eigen::Vector3d tip{0, 0, 0};
  Eigen::Vector3d axis{0, 0, 1};  ///< along the tube from the tip back to the handle; any length but zero
  Nanoseconds now = 0;            ///< instant of the harvester's pose, for the age of the surface
};

/// Why there is no normal, or why it is only a substitute. Every value but `none` keeps the angle off the
/// screen.
enum class NormalReason : std::uint8_t {
  none = 0,             ///< the normal is good
  bad_query,            ///< tip or axis is not finite, or the axis has no length
  no_surface,           ///< nothing scanned near the tip
  axis_misses_surface,  ///< the axis does not meet the scanned surface within reach
  too_few_points,       ///< points near the foot below the limit
  too_few_lines,        ///< lines near the foot below the limit: their shared errors do not average out
  one_sided,            ///< the foot lies at the edge of the scan: a side has no points
  gap,                  ///< the foot lies in a hole of the scan
  too_old,              ///< the newest line near the foot is older than the limit
  too_uncertain,        ///< the 95 % cone of the normal is wider than the limit
  too_curved,           ///< the surface turns within the smallest patch: a crease, or a radius of few mm
  no_triangle,          ///< Algorithm 1 only: no three points qualify; the normal is the fallback k (Eq 5.4)
};

/// For people: "not enough lines here" and the like.
std::string_view name(NormalReason reason);

enum class NormalMethod : std::uint8_t {
  algorithm_1 = 0,  ///< the thesis's inscribed triangle; no uncertainty
  robust = 1,       ///< robust local quadric with its 95 % interval
};

/// What the estimate stands on.
struct NormalCounts {
  int points = 0;           ///< used
  int lines = 0;            ///< used
  int points_rejected = 0;  ///< near the foot, but wild or of another layer
  int lines_rejected = 0;   ///< near the foot, no point of the line used
};

/// A value without a reason to doubt it, or a reason. When `reason` is not `none`, only `counts`, `age` and
/// what is finite may be looked at (a `too_uncertain` estimate still holds its numbers, for diagnostics).
struct NormalEstimate {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

  NormalReason reason = NormalReason::no_surface;
  NormalMethod method = NormalMethod::robust;
  bool fallback = false;  ///< Eq 5.4's second case: `normal` is the depth direction k, no measured normal

  Eigen::Vector3d foot = Eigen::Vector3d::Constant(kNone);     ///< where the axis meets the surface
  Eigen::Vector3d normal = Eigen::Vector3d::Constant(kNone);   ///< there; unit, out of the surface
  Eigen::Vector3d nearest = Eigen::Vector3d::Constant(kNone);  ///< point of the surface nearest to the tip
  Eigen::Vector3d nearest_normal = Eigen::Vector3d::Constant(kNone);  ///< there

  double distance = kNone;  ///< tip to `nearest`, positive outside the surface, mm
  double depth =
      kNone;  ///< along the axis from the tip to `foot`, positive before contact, negative inside, mm

  double angle = kNone;      ///< Eq 5.3: between normal and axis, radians, [0, pi]
  double angle_low = kNone;  ///< 95 % interval of `angle`, radians
  double angle_high = kNone;
  double normal_uncertainty =
      kNone;  ///< half angle of the cone about `normal` that holds the true one in 95 %, radians
  double radius_of_fit = kNone;  ///< of the patch the estimate used, mm

  NormalCounts counts;
  Nanoseconds age = 0;  ///< of the newest line used

  bool good() const { return reason == NormalReason::none; }
};

}  // namespace linescope
