#include "acquire/twin/prism_sheet.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "acquire/twin/prism.hpp"
#include "acquire/twin/snell.hpp"

namespace linescope::twin {
namespace {

using Eigen::Vector3d;

constexpr double kAirGap = 0.3;       // mm, fibre's tip to face 1
constexpr double kPrismLength = 2.0;  // mm, face 1 to face 2 along the axis

double slope_of_sine(double sine) {
  return sine / std::sqrt(1 - sine * sine);
}

}  // namespace

Result<PrismSheet> PrismSheet::create(double baseline_mm, double alpha_rad, const PrismOptions& options) {
  const auto apex =
      apex_for_deviation({options.air_index, options.prism_index, options.medium_index}, alpha_rad);
  if (!apex) return tl::unexpected(apex.error());
  return PrismSheet(baseline_mm, *apex, options);
}

PrismSheet::PrismSheet(double baseline_mm, double apex, const PrismOptions& options)
    : baseline_(baseline_mm),
      apex_(apex),
      options_(options),
      face_normal_(0, -std::sin(apex), std::cos(apex)) {
  largest_sine_ = largest_sine();
}

// Sideways nothing changes at face 2 (it is inclined only in y-z), so the sines along x follow Snell at once:
// n_a sin(air) = n_p sin(prism) = n_w sin(medium). Total reflection begins where the cosine to the face gets
// too small.
double PrismSheet::largest_sine() const {
  const double ratio = options_.medium_index / options_.prism_index;
  const double smallest_cosine = std::sqrt(std::max(0.0, 1 - ratio * ratio)) / std::cos(apex_);
  const double in_prism = std::sqrt(std::max(0.0, 1 - smallest_cosine * smallest_cosine));
  const double by_reflection = in_prism * options_.prism_index / options_.medium_index;
  return 0.999 * std::min(by_reflection, options_.air_index / options_.medium_index);
}

SheetRay PrismSheet::ray_with_sine(double sine) const {
  const double in_air = sine * options_.medium_index / options_.air_index;
  const double in_prism = sine * options_.medium_index / options_.prism_index;
  const double sideways = kAirGap * slope_of_sine(in_air) + kPrismLength * slope_of_sine(in_prism);
  const Vector3d inside{in_prism, 0, std::sqrt(1 - in_prism * in_prism)};
  const auto out = refracted(inside, face_normal_, options_.prism_index, options_.medium_index);
  return {Vector3d(sideways, -baseline_, 0), *out};
}

std::optional<SheetRay> PrismSheet::ray(double angle_in_air) const {
  const double sine = std::sin(angle_in_air) * options_.air_index / options_.medium_index;
  if (std::abs(sine) > largest_sine_) return std::nullopt;
  return ray_with_sine(sine);
}

// Finds the ray whose x at the point's depth is the point's x. x grows with the sine: secant steps inside a
// bracket.
SheetPlace PrismSheet::at(const Vector3d& point) const {
  const auto x_at = [&](const SheetRay& ray) {
    return ray.origin.x() + point.z() * ray.direction.x() / ray.direction.z();
  };
  const auto y_at = [&](const SheetRay& ray) {
    return ray.origin.y() + point.z() * ray.direction.y() / ray.direction.z();
  };
  double sine = std::clamp(point.x() / std::hypot(point.x(), point.z() + 2), -largest_sine_, largest_sine_);
  SheetRay ray = ray_with_sine(sine);
  constexpr double kStep = 1e-5;
  for (int i = 0; i < 6; ++i) {
    const double miss = point.x() - x_at(ray);
    if (std::abs(miss) < 1e-10) break;
    const double other = sine > 0 ? sine - kStep : sine + kStep;
    const double growth = (x_at(ray) - x_at(ray_with_sine(other))) / (sine - other);
    sine = std::clamp(sine + miss / growth, -largest_sine_, largest_sine_);
    ray = ray_with_sine(sine);
  }
  const SheetRay beside = ray_with_sine(sine > 0 ? sine - kStep : sine + kStep);
  const double dy_dx = (y_at(ray) - y_at(beside)) / (x_at(ray) - x_at(beside));
  const double dy_dz = ray.direction.y() / ray.direction.z() - dy_dx * ray.direction.x() / ray.direction.z();
  const double along = point.z() / ray.direction.z();
  SheetPlace place;
  place.offset = (point.y() - y_at(ray)) / std::sqrt(1 + dy_dx * dy_dx + dy_dz * dy_dz);
  place.fan_angle = std::asin(sine);
  place.distance = along + kPrismLength;
  place.direction = ray.direction;
  return place;
}

}  // namespace linescope::twin
