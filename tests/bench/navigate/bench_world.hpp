// The scans that navigation is measured on, the spots asked for, and how times and errors are tallied.
#pragma once

#include <time.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <vector>

#include "tests/unit/navigate/phantoms.hpp"
#include "viewer/navigate/angle_difference.hpp"

namespace linescope::bench {

using namespace phantom;

inline double microseconds() {
  return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

/// Of this thread alone: what a scheduler takes away does not count.
inline double processor_microseconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e6 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_nsec);
}

inline double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const auto place =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

/// A condyle patch scanned at 376 points / mm^2; large: a million points on an ellipsoid 3.5 times the size.
struct World {
  World(bool large, const Noise& noise) {
    const double scale = large ? 3.54 : 1.0;
    surface =
        ellipsoid("condyle", 25 * scale, 22 * scale, 25 * scale, large ? 44.3 : 12.5, large ? 15.0 : 5.0);
    Scanner scanner(12345);
    scanner.sweep(surface, {.points_per_line = large ? 1920 : 640}, noise, 0, scan);
    add_all(estimator, scan);
    for (const ScannedLine& line : scan)
      for (const SurfacePoint& p : line.points) points.push_back(p.position);
    for (int i = 0; i < 2000; ++i)
      spots.push_back(spot_at(surface, scanner.uniform(-1, 1) * (surface.half_length - 3),
                              scanner.uniform(-1, 1) * (surface.half_width - 3), 0.05, i,
                              scanner.uniform(0, 1)));
  }
  Surface surface;
  Scan scan;
  NormalEstimator estimator;
  std::vector<Eigen::Vector3f> points;
  std::vector<PlacedSpot> spots;
};

/// Times and errors of one way.
struct Tally {
  std::vector<double> times;            ///< by the clock on the wall
  std::vector<double> processor_times;  ///< by the processor's
  double error = 0;
  int asked = 0, answered = 0;

  template <class Ask>
  void time(Ask&& ask, const Eigen::Vector3d& truth) {
    const double processor_start = processor_microseconds(), start = microseconds();
    const std::optional<Eigen::Vector3d> normal = ask();
    const double end = microseconds();
    processor_times.push_back(processor_microseconds() - processor_start);
    times.push_back(end - start);
    ++asked;
    if (!normal) return;
    const double angle = angle_difference(*normal, truth);
    error += degrees_from_radians(std::min(angle, M_PI - angle));  // peers do not know the outside
    ++answered;
  }
  double median() const { return percentile(times, 0.5); }
  double mean_error() const { return error / std::max(answered, 1); }
};

}  // namespace linescope::bench
