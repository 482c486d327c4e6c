#include "tools/calibrate/still_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "common/units.hpp"
#include "tools/calibrate/verdict.hpp"

namespace linescope::calibrate {
namespace {

using Eigen::Vector3d;
using Stretch = std::span<const PoseSample>;

constexpr double kStillMm = 2;
constexpr double kStillRad = 0.0175;

bool near(const PoseSample& a, const PoseSample& b) {
  return (a.world_from_sensor.translation() - b.world_from_sensor.translation()).norm() <= kStillMm &&
         a.world_from_sensor.rotation().angularDistance(b.world_from_sensor.rotation()) <= kStillRad;
}

double seconds_of(Stretch stretch) {
  return stretch.empty() ? 0 : seconds_from(stretch.back().time - stretch.front().time);
}

Stretch longest(Stretch samples) {
  Stretch best;
  std::size_t first = 0;
  for (std::size_t i = 0; i <= samples.size(); ++i) {
    const bool goes_on = i < samples.size() && usable(samples[i].state) && near(samples[first], samples[i]);
    if (goes_on) continue;
    const Stretch here = samples.subspan(first, i - first);
    if (seconds_of(here) > seconds_of(best)) best = here;
    while (i < samples.size() && !usable(samples[i].state)) ++i;
    first = i;
  }
  return best;
}

Vector3d mean_place(Stretch stretch) {
  Vector3d sum = Vector3d::Zero();
  for (const PoseSample& s : stretch) sum += s.world_from_sensor.translation();
  return sum / static_cast<double>(stretch.size());
}

Eigen::Quaterniond mean_attitude(Stretch stretch) {
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  const Eigen::Quaterniond& first = stretch.front().world_from_sensor.rotation();
  for (const PoseSample& s : stretch) {
    const Eigen::Quaterniond& q = s.world_from_sensor.rotation();
    sum += q.dot(first) < 0 ? Eigen::Vector4d(-q.coeffs()) : q.coeffs();
  }
  return Eigen::Quaterniond(Eigen::Vector4d(sum.normalized()));
}

double mean_distortion(Stretch stretch) {
  double sum = 0, count = 0;
  for (const PoseSample& s : stretch) {
    if (!std::isfinite(s.distortion)) continue;
    sum += s.distortion;
    ++count;
  }
  return count > 0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
}

StillStation figures_of(Stretch stretch, int station) {
  StillStation f;
  f.station = station;
  f.seconds = seconds_of(stretch);
  f.samples = stretch.size();
  const Vector3d place = mean_place(stretch);
  const Eigen::Quaterniond attitude = mean_attitude(stretch);
  double mm = 0, rad = 0;
  for (const PoseSample& s : stretch) {
    f.course.push_back(
        {seconds_from(s.time - stretch.front().time), s.world_from_sensor.translation() - place});
    mm += (s.world_from_sensor.translation() - place).squaredNorm();
    rad += std::pow(attitude.angularDistance(s.world_from_sensor.rotation()), 2);
  }
  const auto n = static_cast<double>(stretch.size());
  f.jitter_mm = std::sqrt(mm / n);
  f.jitter_deg = degrees_from_radians(std::sqrt(rad / n));
  const std::size_t half = stretch.size() / 2;
  f.drift_mm = (mean_place(stretch.subspan(half)) - mean_place(stretch.first(half))).norm();
  f.distortion = mean_distortion(stretch);
  return f;
}

}  // namespace

Result<void> validate(const StillOptions& o) {
  const double limits[] = {o.most_jitter_mm, o.most_jitter_deg, o.most_drift_mm};
  const bool limits_fit =
      std::all_of(std::begin(limits), std::end(limits), [](double l) { return l >= 0.001 && l <= 10; });
  if (o.least_seconds >= 0.5 && o.least_seconds <= 600 && o.most_distortion >= 0 &&
      o.most_distortion <= 1e6 && limits_fit)
    return {};
  return fail(
      ErrorCode::invalid,
      "the test of the still tracker needs 0.5 to 600 s, limits of 0.001 to 10 mm and degrees, and 0 to 1e6 "
      "of the metal indicator");
}

StillStation still_stretch(const std::vector<PoseSample>& samples, int station) {
  const Stretch stretch = longest(samples);
  if (stretch.size() >= 2) return figures_of(stretch, station);
  StillStation none;
  none.station = station;
  return none;
}

Result<std::vector<StillStation>> check_still(const std::vector<StillStation>& stations,
                                              const StillOptions& options) {
  std::vector<StillStation> still;
  double best = 0;
  for (const StillStation& s : stations) {
    best = std::max(best, s.seconds);
    if (s.seconds >= options.least_seconds) still.push_back(s);
  }
  if (!still.empty()) return still;
  return tl::unexpected(refusal(
      Refusal::too_few,
      fmt::format("no sensor stood still for {:g} s (the longest was {:.1f} s)", options.least_seconds, best),
      "Lay at least one tracked tool down while the check runs"));
}

Result<void> above_limit(const std::vector<StillStation>& stations, const StillOptions& options) {
  std::string found;
  const auto add = [&](int station, const char* what, double value, double limit, const char* unit) {
    if (!(value > limit)) return;
    found += fmt::format("{}sensor {}: {} {:.3f}{} (limit {:g})", found.empty() ? "" : ", ", station + 1,
                         what, value, unit, limit);
  };
  for (const StillStation& s : stations) {
    add(s.station, "jitter", s.jitter_mm, options.most_jitter_mm, " mm");
    add(s.station, "jitter", s.jitter_deg, options.most_jitter_deg, " deg");
    add(s.station, "drift", s.drift_mm, options.most_drift_mm, " mm");
    add(s.station, "metal indicator", s.distortion, options.most_distortion, "");
  }
  if (found.empty()) return {};
  return tl::unexpected(
      refusal(Refusal::error_above_limit, found,
              "Move metal, screens and motors away from transmitter and sensors and check the cables"));
}

}  // namespace linescope::calibrate
