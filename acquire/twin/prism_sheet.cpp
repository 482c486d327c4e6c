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

constexpr int kKnots = 2048;

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
  tabulate();
}

// Sideways nothing changes at face 2 (it is inclined only in y-z), so the sines along x follow Snell at once:
// n_a sin(air) = n_p sin(prism) = n_w sin(medium). Total reflection begins where the cosine to the face gets
// too small.
double PrismSheet::largest_sine() const {
  const double ratio = options_.medium_index / options_.prism_index;
  const double smallest_cosine = std::sqrt(std::max(0.0, 1 - ratio * ratio)) / std::cos(apex_);
  const double in_prism = std::sqrt(std::max(0.0, 1 - smallest_cosine * smallest_cosine));
  const double by_reflection = in_prism * options_.prism_index / options_.medium_index;
  return 0.99 * std::min(by_reflection, options_.air_index / options_.medium_index);
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

std::optional<SheetRay> PrismSheet::ray_in_medium(double angle) const {
  if (std::abs(std::sin(angle)) > largest_sine_) return std::nullopt;
  return ray_with_sine(std::sin(angle));
}

PrismSheet::Run PrismSheet::run_of(double sine) const {
  const SheetRay ray = ray_with_sine(sine);
  return {ray.origin.x(), ray.direction.x() / ray.direction.z(), ray.direction.y() / ray.direction.z()};
}

void PrismSheet::tabulate() {
  const double step = 2 * largest_sine_ / (kKnots - 1), tiny = 1e-6;
  for (int i = 0; i < kKnots; ++i) {
    const double sine = -largest_sine_ + i * step;
    const Run at = run_of(sine), before = run_of(sine - tiny), after = run_of(sine + tiny);
    const auto slope = [tiny](double low, double high) { return (high - low) / (2 * tiny); };
    knots_.push_back(
        {at, {slope(before.x, after.x), slope(before.dx_dz, after.dx_dz), slope(before.dy_dz, after.dy_dz)}});
  }
}

// Cubic through values and slopes of the two knots around: exact to some 1e-9 mm at working distances.
PrismSheet::Knot PrismSheet::interpolated(double sine) const {
  const double step = 2 * largest_sine_ / (kKnots - 1), place = (sine + largest_sine_) / step;
  const int index = std::clamp(static_cast<int>(place), 0, kKnots - 2);
  const double t = place - index, r = 1 - t;
  const Knot &a = knots_[static_cast<std::size_t>(index)], &b = knots_[static_cast<std::size_t>(index) + 1];
  const auto value = [&](double va, double sa, double vb, double sb) {
    return r * r * ((1 + 2 * t) * va + t * step * sa) + t * t * ((3 - 2 * t) * vb - r * step * sb);
  };
  const auto slope = [&](double va, double sa, double vb, double sb) {
    return 6 * t * r * (vb - va) / step + r * (1 - 3 * t) * sa + t * (3 * t - 2) * sb;
  };
  const Run &va = a.value, &sa = a.slope, &vb = b.value, &sb = b.slope;
  return {{value(va.x, sa.x, vb.x, sb.x), value(va.dx_dz, sa.dx_dz, vb.dx_dz, sb.dx_dz),
           value(va.dy_dz, sa.dy_dz, vb.dy_dz, sb.dy_dz)},
          {slope(va.x, sa.x, vb.x, sb.x), slope(va.dx_dz, sa.dx_dz, vb.dx_dz, sb.dx_dz),
           slope(va.dy_dz, sa.dy_dz, vb.dy_dz, sb.dy_dz)}};
}

// Newton's search for the ray whose x at the point's depth is the point's x; x grows with the sine.
SheetPlace PrismSheet::at(const Vector3d& point) const {
  const double z = point.z();
  double sine = std::clamp(point.x() / std::hypot(point.x(), z + 1.5), -largest_sine_, largest_sine_);
  Knot run = interpolated(sine);
  for (int i = 0; i < 6; ++i) {
    const double miss = point.x() - (run.value.x + z * run.value.dx_dz);
    if (std::abs(miss) < 1e-9) break;
    sine = std::clamp(sine + miss / (run.slope.x + z * run.slope.dx_dz), -largest_sine_, largest_sine_);
    run = interpolated(sine);
  }
  // The sheet as y(x, z): along x the sine changes, along z the ray runs on.
  const double dy_dx = z * run.slope.dy_dz / (run.slope.x + z * run.slope.dx_dz);
  const double dy_dz = run.value.dy_dz - dy_dx * run.value.dx_dz;
  const double length = std::sqrt(1 + run.value.dx_dz * run.value.dx_dz + run.value.dy_dz * run.value.dy_dz);
  SheetPlace place;
  place.offset = (point.y() + baseline_ - z * run.value.dy_dz) / std::sqrt(1 + dy_dx * dy_dx + dy_dz * dy_dz);
  place.fan_angle = std::asin(sine);
  place.distance = z * length + kPrismLength;
  place.direction = Vector3d(run.value.dx_dz, run.value.dy_dz, 1) / length;
  return place;
}

}  // namespace linescope::twin
