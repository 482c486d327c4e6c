#include "acquire/twin/ideal_calibration.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <vector>

#include "acquire/twin/fitted_lens.hpp"
#include "acquire/twin/prism_sheet.hpp"

namespace linescope::twin {
namespace {

using Eigen::Vector3d;

constexpr double kNearest = 8, kFarthest = 22;  // mm, the working range

// Plane normal . p = offset in the camera's frame with y down.
struct Plane {
  Vector3d normal;
  double offset;
};

Plane flat_sheet(const InstrumentOptions& instrument) {
  const double s = std::sin(instrument.alpha_rad), c = std::cos(instrument.alpha_rad);
  return {Vector3d(0, -c, s), instrument.baseline_mm * c};
}

struct LitPoint {
  Vector3d position;
  double weight;  ///< light of the fan there
};

std::vector<LitPoint> lit_points(const PrismSheet& sheet, const LineOptions& line) {
  std::vector<LitPoint> points;
  for (int i = -30; i <= 30; ++i) {
    const double fan = i / 20.0;  // in half angles: to one and a half, where the light is 1 % of the middle's
    const auto ray = sheet.ray_in_medium(fan * line.fan_half_angle_rad);
    if (!ray) continue;
    for (double z = kNearest; z <= kFarthest; z += 1) {
      points.push_back({ray->origin + ray->direction * (z / ray->direction.z()), std::exp(-2 * fan * fan)});
    }
  }
  return points;
}

// Least squares of perpendicular distances over the working range.
Plane fitted_plane(const PrismSheet& sheet, const TwinOptions& options) {
  const std::vector<LitPoint> points = lit_points(sheet, options.optics.line);
  double weight = 0;
  Vector3d mean = Vector3d::Zero();
  for (const LitPoint& p : points) {
    mean += p.weight * p.position;
    weight += p.weight;
  }
  mean /= weight;
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const LitPoint& p : points)
    scatter += p.weight * (p.position - mean) * (p.position - mean).transpose();
  Vector3d normal = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter).eigenvectors().col(0);
  if (normal.dot(mean) < 0) normal = -normal;
  return {normal, normal.dot(mean)};
}

Plane sheet_plane(const TwinOptions& options) {
  if (!options.optics.prism.refracted_sheet) return flat_sheet(options.instrument);
  const auto sheet =
      PrismSheet::create(options.instrument.baseline_mm, options.instrument.alpha_rad, options.optics.prism);
  return sheet ? fitted_plane(*sheet, options) : flat_sheet(options.instrument);
}

}  // namespace

Calibration ideal_calibration(const TwinOptions& options) {
  const InstrumentOptions& instrument = options.instrument;
  const LensNumbers lens = options.optics.port.refraction ? fitted_lens(options) : instrument.lens;
  Calibration calibration;
  calibration.name = "digital twin";
  calibration.camera = {lens.width, lens.height, lens.fx, lens.fy, 0, lens.cx, lens.cy, lens.distortion};
  const Plane plane = sheet_plane(options);
  // The product's plane lives in the thesis's frame, y up. Turned here by hand: a slip of sign must not be
  // shared.
  calibration.laser = {Vector3d(plane.normal.x(), -plane.normal.y(), plane.normal.z()), plane.offset};
  calibration.endoscope_from_camera = instrument.endoscope_from_camera;
  calibration.harvester = {instrument.harvester_tip, instrument.harvester_axis};
  calibration.camera_latency = instrument.latency;
  if (options.optics.port.refraction)
    calibration.notes.push_back("lens: best fit of a pinhole to a flat port in the medium");
  if (options.optics.prism.refracted_sheet)
    calibration.notes.push_back("laser plane: best fit to the sheet bent by the prism");
  return calibration;
}

}  // namespace linescope::twin
