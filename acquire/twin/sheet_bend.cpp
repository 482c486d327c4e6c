#include "acquire/twin/sheet_bend.hpp"

#include <algorithm>
#include <cmath>

#include "acquire/twin/ideal_calibration.hpp"
#include "acquire/twin/prism_sheet.hpp"

namespace linescope::twin {
namespace {

using Eigen::Vector3d;

constexpr int kHalfSteps = 60;
constexpr double kEdge = 1.5;  // half angles, where the light is one per cent of the middle's

// The camera at the origin sees `point` (y down) along the ray through it and takes it for where that ray
// meets the plane.
double depth_by_plane(const LaserPlane& plane, const Vector3d& point) {
  const Vector3d up{point.x() / point.z(), -point.y() / point.z(), 1};
  return plane.offset / plane.normal.dot(up);
}

PlaneError error_at(const PrismSheet& sheet, const LaserPlane& plane, const LineOptions& line, double gap) {
  PlaneError result;
  result.gap_mm = gap;
  double light = 0, sum = 0, squares = 0;
  for (int i = -kHalfSteps; i <= kHalfSteps; ++i) {
    const double fan = kEdge * i / kHalfSteps;
    const auto ray = sheet.ray_in_medium(fan * line.fan_half_angle_rad);
    if (!ray) continue;
    const Vector3d point = ray->origin + ray->direction * (gap / ray->direction.z());
    const double error = depth_by_plane(plane, point) - gap, weight = std::exp(-2 * fan * fan);
    light += weight;
    sum += weight * error;
    squares += weight * error * error;
    if (std::abs(fan) <= 1) result.worst_mm = std::max(result.worst_mm, std::abs(error));
  }
  result.mean_mm = sum / light;
  result.sd_mm = std::sqrt(std::max(0.0, squares / light - result.mean_mm * result.mean_mm));
  return result;
}

}  // namespace

Result<std::vector<PlaneError>> plane_errors(TwinOptions options, const std::vector<double>& gaps_mm) {
  options.optics.prism.refracted_sheet = true;
  const InstrumentOptions& instrument = options.instrument;
  const auto sheet = PrismSheet::create(instrument.baseline_mm, instrument.alpha_rad, options.optics.prism);
  if (!sheet) return tl::unexpected(sheet.error());
  const LaserPlane plane = ideal_calibration(options).laser;
  std::vector<PlaneError> errors;
  for (const double gap : gaps_mm) errors.push_back(error_at(*sheet, plane, options.optics.line, gap));
  return errors;
}

}  // namespace linescope::twin
