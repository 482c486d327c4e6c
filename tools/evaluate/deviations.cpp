#include "tools/evaluate/deviations.hpp"

#include <cmath>
#include <limits>

namespace linescope::evaluate {

Deviations deviations_of(const std::vector<double>& distances) {
  Deviations d;
  d.count = distances.size();
  if (distances.empty()) return d;
  const auto n = static_cast<double>(distances.size());
  double squares = 0;
  for (const double e : distances) {
    d.mean += e / n;
    squares += e * e / n;
  }
  double about_mean = 0;
  for (const double e : distances) about_mean += (e - d.mean) * (e - d.mean);
  d.deviation = distances.size() > 1 ? std::sqrt(about_mean / (n - 1)) : 0;
  d.rms = std::sqrt(squares);
  return d;
}

Deviations deviations_of(const HeldLines& lines, const twin::TwinTruth& truth, Nanoseconds from,
                         Nanoseconds to) {
  std::vector<double> distances;
  for (const auto& line : lines) {
    if (line->time < from || line->time >= to) continue;
    for (const SurfacePoint& p : line->points) distances.push_back(truth.distance(p.position.cast<double>()));
  }
  return deviations_of(distances);
}

Deviations deviations_of(const HeldLines& lines, const twin::TwinTruth& truth) {
  return deviations_of(lines, truth, std::numeric_limits<Nanoseconds>::min(),
                       std::numeric_limits<Nanoseconds>::max());
}

Deviations deviations_of(const std::vector<Eigen::Vector3f>& places, const twin::TwinTruth& truth) {
  std::vector<double> distances;
  distances.reserve(places.size());
  for (const Eigen::Vector3f& p : places) distances.push_back(truth.distance(p.cast<double>()));
  return deviations_of(distances);
}

}  // namespace linescope::evaluate
