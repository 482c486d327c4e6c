// Analytic scans with known truth for the surface tests and benchmarks: seeded, the same on every machine.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "viewer/surface/mesher.hpp"

namespace linescope::testing {

/// splitmix64 and Box-Muller: no standard distribution, whose numbers differ between libraries.
class Noise {
 public:
  explicit Noise(std::uint64_t seed) : state_(seed) {}
  std::uint64_t bits() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15ull);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    return z ^ (z >> 31);
  }
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1.0p-53; }
  double gauss() {
    const double radius = std::sqrt(-2 * std::log(1 - uniform()));
    return radius * std::cos(2 * std::numbers::pi * uniform());
  }

 private:
  std::uint64_t state_;
};

/// An ellipsoid about the origin: the condyle. Distances are to first order, exact enough within 1 mm of a 22
/// mm radius.
struct Ellipsoid {
  Eigen::Vector3d axes{25, 22, 25};

  Eigen::Vector3d normal(const Eigen::Vector3d& p) const {
    return p.cwiseQuotient(axes.cwiseAbs2()).normalized();
  }
  double distance(const Eigen::Vector3d& p) const {
    const double k0 = p.cwiseQuotient(axes).norm(), k1 = p.cwiseQuotient(axes.cwiseAbs2()).norm();
    return k0 * (k0 - 1) / k1;
  }
  double height(double x, double y) const {
    return axes.z() * std::sqrt(1 - x * x / (axes.x() * axes.x()) - y * y / (axes.y() * axes.y()));
  }
};

/// How a phantom is scanned. The defaults are the thesis's donor site: 94,080 points on 25 x 10 mm.
struct ScanPlan {
  int stripes = 147;  ///< lines per swath
  int swaths = 1;     ///< side by side, each `stripe_length` wide
  int points_per_line = 640;
  double stripe_step = 0.17;    ///< mm between lines
  double stripe_length = 10.0;  ///< mm
  int repeats = 1;              ///< the same area scanned so often
  double noise = 0.26;          ///< mm along the normal, every point by itself
  double line_offset = 0.0;     ///< mm along the normal, the same for a whole line (tracker)
  double line_tilt = 0.0;       ///< rad about the line's middle, in the plane of line and normal (tracker)
  std::uint64_t seed = 12345;
  Eigen::Isometry3d pose =
      Eigen::Isometry3d::Identity();  ///< where the phantom lies in the frame of the points

  double length() const { return stripes * stripe_step; }
  double width() const { return swaths * stripe_length; }
};

struct ScannedLine {
  std::vector<SurfacePoint> points;
  Eigen::Vector3d seen_from;
  Nanoseconds time = 0;

  SurfaceLine view() const { return {.points = points, .seen_from = seen_from, .time = time}; }
};

/// Scans the top (+z) of an ellipsoid whose axes are scaled with the length of the scan, as in the
/// performance page.
struct CondyleScan {
  ScanPlan plan;
  Ellipsoid truth;
  std::vector<ScannedLine> lines;

  /// Signed distance of a point (frame of the points) to the truth, mm.
  double distance(const Eigen::Vector3f& p) const {
    return truth.distance(plan.pose.inverse() * p.cast<double>());
  }

  /// How far a point lies beyond the scanned rectangle, mm; negative inside.
  double beyond_border(const Eigen::Vector3f& p) const {
    const Eigen::Vector3d q = plan.pose.inverse() * p.cast<double>();
    return std::max(std::abs(q.x()) - plan.length() / 2, std::abs(q.y()) - plan.width() / 2);
  }

  std::size_t point_count() const {
    std::size_t count = 0;
    for (const ScannedLine& line : lines) count += line.points.size();
    return count;
  }
};

inline ScannedLine scan_line(const CondyleScan& scan, int swath, int stripe, int number, Noise& noise) {
  const ScanPlan& plan = scan.plan;
  ScannedLine line;
  line.time = static_cast<Nanoseconds>(number + 1) * 10 * kMillisecond;
  const double x0 = -plan.length() / 2 + (stripe + 0.5) * plan.stripe_step;
  const double middle = -plan.width() / 2 + (swath + 0.5) * plan.stripe_length;
  const double offset = plan.line_offset * noise.gauss(), tilt = plan.line_tilt * noise.gauss();
  const Eigen::Vector3d center{x0, middle, scan.truth.height(x0, middle)};
  line.seen_from = plan.pose * (center + 15.0 * scan.truth.normal(center));
  for (int i = 0; i < plan.points_per_line; ++i) {
    const double y = middle + ((i + 0.5) / plan.points_per_line - 0.5) * plan.stripe_length;
    const double x = x0 + 0.01 * std::sin(i * 0.02);
    const Eigen::Vector3d p{x, y, scan.truth.height(x, y)};
    const double error = plan.noise * noise.gauss() + offset + tilt * (y - middle);
    const Eigen::Vector3d seen = plan.pose * (p + error * scan.truth.normal(p));
    line.points.push_back({seen.cast<float>(), 200.0f, static_cast<float>(plan.noise)});
  }
  return line;
}

inline CondyleScan scan_condyle(const ScanPlan& plan = {}) {
  CondyleScan scan{plan, {}, {}};
  scan.truth.axes *= std::max(1.0, plan.length() / 25.0);
  Noise noise(plan.seed);
  int number = 0;
  for (int repeat = 0; repeat < plan.repeats; ++repeat)
    for (int swath = 0; swath < plan.swaths; ++swath)
      for (int stripe = 0; stripe < plan.stripes; ++stripe)
        scan.lines.push_back(scan_line(scan, swath, stripe, number++, noise));
  return scan;
}

inline void add_all(Mesher& mesher, const std::vector<ScannedLine>& lines) {
  for (const ScannedLine& line : lines) mesher.add_line(line.view());
}

/// Distances of the vertices to the truth, away from the border by `margin` mm.
struct MeshAccuracy {
  double rms = 0, mean = 0, p95 = 0, worst = 0;  ///< mm
  std::size_t vertices = 0;
  double deviation = 0;   ///< mm, about the mean
  std::size_t stray = 0;  ///< farther than `stray_beyond`: counted, left out of the figures
};

MeshAccuracy accuracy_of(const TriangleMesh& mesh, const CondyleScan& scan, double margin,
                         double stray_beyond = 1.0);

/// Root mean square over all vertices within the same margin, stray or not.
double rms_of_all(const TriangleMesh& mesh, const CondyleScan& scan, double margin);

}  // namespace linescope::testing
