#include "acquire/twin/laser_light.hpp"

#include <algorithm>
#include <cmath>

#include "acquire/twin/noise_texture.hpp"

namespace linescope::twin {
namespace {

constexpr double kTissuePerRadian = 14;  // soft tissue hides stretches of about a twelfth of the fan
constexpr double kTissuePerSecond = 1.5;
constexpr double kTissuePasses = 0.02;
constexpr double kGhostWaver = 0.3;     // share of the offset by which it winds
constexpr double kGhostWidening = 2.0;  // the reflection is that much wider
constexpr double kGhostOffset = 1.6;    // mm between the line and its reflection in a wet neighbour

double bell(double x) {
  return std::exp(-0.5 * x * x);
}

}  // namespace

LaserLight::LaserLight(std::uint64_t seed, const LaserSheet& sheet, const OpticsOptions& options)
    : seed_(scrambled(seed + 78)),
      sheet_(sheet),
      line_(options.line),
      trouble_(options.trouble),
      missing_threshold_(threshold_for_share(options.trouble.missing)) {}

double LaserLight::sigma(double distance) const {
  const double blur = line_.defocus_per_mm * (distance - line_.focus_distance_mm);
  return std::hypot(line_.width_sigma_mm, blur);
}

LaserLight::Band LaserLight::band(double distance) const {
  const double reach = line_.sheet_reach_sigmas * sigma(distance);
  if (!(trouble_.inter_reflection > 0)) return {-reach, reach};
  return {-reach, kGhostOffset * (1 + kGhostWaver) + kGhostWidening * reach};
}

bool LaserLight::touches(const SheetPlace& place, double shift) const {
  const Band lit = band(place.distance);
  return place.offset >= lit.low - shift && place.offset <= lit.high + shift;
}

double LaserLight::passing(double fan_angle, double seconds) const {
  if (!(missing_threshold_ > 0)) return 1;
  const Eigen::Vector3d place(fan_angle * kTissuePerRadian, seconds * kTissuePerSecond, 0.5);
  return smooth_noise(seed_, place) < missing_threshold_ ? kTissuePasses : 1;
}

// A fan spreads in one direction: its light per area falls with the distance, not with its square; a wider
// profile holds the same light.
double LaserLight::level(const SheetPlace& place, const Eigen::Vector3d& normal, double seconds) const {
  const double cosine = -place.direction.dot(normal);
  if (!(cosine > 0)) return 0;
  const double width = sigma(place.distance);
  const double limit = line_.sheet_reach_sigmas;
  const double across = place.offset / width;
  double profile = std::abs(across) <= limit ? bell(across) : 0;
  if (trouble_.inter_reflection > 0) {
    const double ghost =
        (place.offset - kGhostOffset * (1 + kGhostWaver * std::sin(9 * place.fan_angle + seconds))) /
        (kGhostWidening * width);
    if (std::abs(ghost) <= limit) profile += trouble_.inter_reflection * bell(ghost);
  }
  if (!(profile > 0)) return 0;
  const double fan = place.fan_angle / line_.fan_half_angle_rad;
  return line_.brightness * (line_.reference_distance_mm / place.distance) * (line_.width_sigma_mm / width) *
         cosine * std::exp(-2 * fan * fan) * profile;
}

}  // namespace linescope::twin
