// Analytic surfaces with exact normals, and laser scans of them with the noise of thesis-notes: the truth for
// navigation.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "common/surface_point.hpp"
#include "common/units.hpp"
#include "viewer/navigate/normal_estimator.hpp"
#include "viewer/navigate/spot_experiment.hpp"

namespace linescope::phantom {

/// Zero level of a smooth function that grows outwards, seen from +z; mm.
struct Surface {
  std::string name;
  std::function<double(const Eigen::Vector3d&)> value;
  std::function<Eigen::Vector3d(const Eigen::Vector3d&)> gradient;
  double half_length = 10;  ///< scanned region in x
  double half_width = 5;    ///< and in y (the line's width is twice this)

  Eigen::Vector3d normal(const Eigen::Vector3d& p) const { return gradient(p).normalized(); }

  /// Where the line from `start` along `direction` first meets the surface (Newton from the start).
  Eigen::Vector3d meet(Eigen::Vector3d start, const Eigen::Vector3d& direction) const {
    for (int i = 0; i < 60; ++i) {
      const double v = value(start);
      start -= v / gradient(start).dot(direction) * direction;
      if (std::abs(v) < 1e-13) break;
    }
    return start;
  }
  Eigen::Vector3d above(double x, double y) const { return meet({x, y, 0.2}, Eigen::Vector3d::UnitZ()); }
};

inline Surface quadratic(std::string name, double xx, double yy, double half_length = 10,
                         double half_width = 5) {
  return {std::move(name),
          [=](const Eigen::Vector3d& p) { return p.z() - xx * p.x() * p.x() - yy * p.y() * p.y(); },
          [=](const Eigen::Vector3d& p) { return Eigen::Vector3d(-2 * xx * p.x(), -2 * yy * p.y(), 1); },
          half_length, half_width};
}
/// Semi-axes a, b, c, top at the origin.
inline Surface ellipsoid(std::string name, double a, double b, double c, double half_length = 10,
                         double half_width = 5) {
  const Eigen::Vector3d inverse(1 / (a * a), 1 / (b * b), 1 / (c * c));
  const Eigen::Vector3d down(0, 0, c);
  return {std::move(name),
          [=](const Eigen::Vector3d& p) { return c / 2 * ((p + down).cwiseAbs2().dot(inverse) - 1); },
          [=](const Eigen::Vector3d& p) { return Eigen::Vector3d(c * (p + down).cwiseProduct(inverse)); },
          half_length, half_width};
}
inline Surface plane() {
  return quadratic("plane", 0, 0);
}
inline Surface sphere() {
  return ellipsoid("sphere 25 mm", 25, 25, 25);
}
/// The validation cylinder, 50 mm in diameter, axis along y.
inline Surface cylinder() {
  return ellipsoid("cylinder 50 mm", 25, 1e9, 25);
}
inline Surface saddle() {
  return quadratic("saddle 25 mm", -0.02, 0.02);
}
inline Surface condyle() {
  return ellipsoid("condyle 25/22/25 mm", 25, 22, 25);
}
/// A cap of 9 x 6 x 2 mm: radii of curvature 6.1 and 3.3 mm at its top.
inline Surface mini_knee() {
  return ellipsoid("mini knee", 4.92, 3.6, 4.0, 3.4, 2.4);
}

/// How wrong the scan is. Standard deviations.
struct Noise {
  double point = 0.02;         ///< white, along the view, mm
  double line = 0;             ///< of each line along the view, mm
  double line_tangential = 0;  ///< of each line across the view, mm
  double line_tilt = 0;        ///< of each line about any axis, rad
  double drift = 0.03;         ///< slow, stationary deviation along the view, mm
  double drift_time = 1.0;     ///< its correlation time, s
  bool smooth_drift = false;   ///< a sine of period 4 drift_time instead of a random process
  double wild = 0;             ///< share of points up to 5 mm off
  double layer = 0;            ///< share of the surface under a second layer 1 to 2 mm above
  double missing = 0;          ///< share of every line that is missing, in runs
};
inline Noise thesis_noise() {
  Noise n;
  n.line = 0.26;
  n.line_tangential = 0.26;
  n.line_tilt = radians_from_degrees(0.1);
  return n;
}

struct Sweep {
  double step = 0.17;  ///< between lines, mm
  int points_per_line = 640;
  double period = 0.01;            ///< between lines, s: 25 mm in 1.47 s, as the thesis scans
  Eigen::Vector3d view{0, 0, -1};  ///< need not be unit
  bool along_y = false;            ///< lines along x, sweep along y
};

struct ScannedLine {
  std::uint64_t id = 0;
  Nanoseconds time = 0;
  Eigen::Vector3d view;
  std::vector<SurfacePoint> points;

  NavigationLine as_line() const { return {id, time, view, points}; }
};
using Scan = std::vector<ScannedLine>;

class Scanner {
 public:
  explicit Scanner(std::uint64_t seed) : random_(seed) {}

  double gauss() { return normal_(random_); }
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  Eigen::Vector3d gauss3() { return {gauss(), gauss(), gauss()}; }

  /// Appends one sweep to a scan, starting at `start` seconds. `keep` may leave points out (holes, edges).
  void sweep(const Surface& s, const Sweep& sweep, const Noise& noise, double start, Scan& scan,
             const std::function<bool(double x, double y)>& keep = {}) {
    const double length = sweep.along_y ? s.half_width : s.half_length;
    const double width = sweep.along_y ? s.half_length : s.half_width;
    const Eigen::Vector3d view = sweep.view.normalized();
    double drift = noise.drift * gauss();
    const double phase = uniform(0, 2 * M_PI);
    const double kept = std::exp(-sweep.period / noise.drift_time);
    place_layer(s, noise);
    const int lines = static_cast<int>(2 * length / sweep.step);
    for (int i = 0; i < lines; ++i) {
      const double t = start + i * sweep.period;
      drift = kept * drift + std::sqrt(1 - kept * kept) * noise.drift * gauss();
      const double slow = noise.smooth_drift ? noise.drift * std::sqrt(2.0) *
                                                   std::sin(phase + M_PI / 2 * (t - start) / noise.drift_time)
                                             : drift;
      ScannedLine line{scan.size(), nanoseconds_from_seconds(t), view, {}};
      const double across = -length + (i + 0.5) * sweep.step;
      const Eigen::Vector3d turn = noise.line_tilt * gauss3();
      Eigen::Vector3d across_view = gauss3();
      across_view -= across_view.dot(view) * view;
      const Eigen::Vector3d shift =
          (noise.line * gauss() + slow) * view + noise.line_tangential * across_view;
      const double hole = uniform(-width, width);
      for (int k = 0; k < sweep.points_per_line; ++k) {
        const double along = -width + (k + 0.5) * 2 * width / sweep.points_per_line;
        const double x = sweep.along_y ? along : across, y = sweep.along_y ? across : along;
        if (noise.missing > 0 && std::abs(std::remainder(along - hole, 2 * width)) < noise.missing * width)
          continue;
        if (keep && !keep(x, y)) continue;
        line.points.push_back(measure(s, x, y, view, noise, turn, shift));
      }
      scan.push_back(std::move(line));
    }
  }

  /// Whether a place is under the second layer, or within `margin` of its edge.
  bool under_layer(double x, double y, double margin) const {
    return layer_half_ > 0 && std::abs(x - layer_x_ + std::sin(1.7 * y)) < layer_half_ + margin;
  }

 private:
  void place_layer(const Surface& s, const Noise& noise) {
    layer_x_ = uniform(-s.half_length, s.half_length);
    layer_half_ = noise.layer * s.half_length;
    layer_height_ = uniform(1.0, 2.0);
  }

  SurfacePoint measure(const Surface& s, double x, double y, const Eigen::Vector3d& view, const Noise& noise,
                       const Eigen::Vector3d& turn, const Eigen::Vector3d& shift) {
    const Eigen::Vector3d truth = s.above(x, y);
    Eigen::Vector3d p = truth + shift + turn.cross(truth) + noise.point * gauss() * view;
    // A flap of tissue with a ragged edge, so that layers also mix within a line.
    if (under_layer(x, y, 0)) p -= layer_height_ * view;
    if (noise.wild > 0 && uniform(0, 1) < noise.wild) p += uniform(-5, 5) * view;
    SurfacePoint point;
    point.position = p.cast<float>();
    point.intensity = 200;
    point.standard_deviation = static_cast<float>(noise.point);
    return point;
  }

  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  double layer_x_ = 0, layer_half_ = 0, layer_height_ = 0;
};

inline void add_all(NormalEstimator& estimator, const Scan& scan) {
  for (const ScannedLine& line : scan) estimator.add_line(line.as_line());
}

/// A harvester set on the surface: axis tilted from the true normal, tip above it.
struct PlacedSpot : Spot {
  Eigen::Vector3d foot;
  double angle = 0;  ///< true, rad
};
inline PlacedSpot spot_at(const Surface& s, double x, double y, double tilt, double turn, double height) {
  PlacedSpot spot;
  spot.foot = s.above(x, y);
  spot.true_normal = s.normal(spot.foot);
  const Eigen::Vector3d side = spot.true_normal.unitOrthogonal();
  const Eigen::Vector3d across = std::cos(turn) * side + std::sin(turn) * spot.true_normal.cross(side);
  spot.query.axis = std::cos(tilt) * spot.true_normal + std::sin(tilt) * across;
  spot.query.tip = spot.foot + height * spot.query.axis;
  spot.query.now = 60 * kSecond;
  spot.true_axis = spot.query.axis;
  spot.angle = tilt;
  return spot;
}

}  // namespace linescope::phantom
