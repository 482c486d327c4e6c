// A tool that swings about its tip or turns about its axis, with errors of known size: plain formulas,
// nothing of the code under test.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "common/units.hpp"
#include "tools/calibrate/tool_poses.hpp"

namespace linescope::calibrate {

struct ToolTruth {
  Eigen::Vector3d tip{-182.0, 6.5, -11.0};
  Eigen::Vector3d axis = Eigen::Vector3d(0.995, -0.035, 0.06).normalized();
  Eigen::Vector3d divot{300, 40, -120};
};

struct PoseErrors {
  double position_mm = 0, rotation_rad = 0;
  unsigned seed = 1;
};

class PoseNoise {
 public:
  explicit PoseNoise(const PoseErrors& errors) : errors_(errors), engine_(errors.seed) {}

  Rigid<Fixture, Harvester> disturbed(const Rigid<Fixture, Harvester>& pose) {
    const Eigen::Vector3d turn = errors_.rotation_rad * normal3();
    const Eigen::Quaterniond small(1, turn.x() / 2, turn.y() / 2, turn.z() / 2);
    return {pose.rotation() * small.normalized(), pose.translation() + errors_.position_mm * normal3()};
  }

 private:
  Eigen::Vector3d normal3() {
    const double x = normal_(engine_), y = normal_(engine_), z = normal_(engine_);
    return {x, y, z};
  }

  PoseErrors errors_;
  std::mt19937_64 engine_;
  std::normal_distribution<double> normal_;
};

inline Eigen::Quaterniond leaning(double x, double y) {
  return Eigen::AngleAxisd(x, Eigen::Vector3d::UnitX()) * Eigen::AngleAxisd(y, Eigen::Vector3d::UnitY()) *
         Eigen::Quaterniond(0.3, 0.5, -0.2, 0.8).normalized();
}

/// `lean`: amplitudes about two axes, rad.
inline ToolPoses pivoting(int count, const PoseErrors& errors, const ToolTruth& truth = {},
                          const Eigen::Vector2d& lean = {0.5, 0.5}) {
  PoseNoise noise(errors);
  ToolPoses poses;
  for (int i = 0; i < count; ++i) {
    const Eigen::Quaterniond turn =
        leaning(lean.x() * std::sin(0.037 * i), lean.y() * std::sin(0.053 * i + 1));
    poses.push_back({i * Nanoseconds{4'166'667}, noise.disturbed({turn, truth.divot - turn * truth.tip})});
  }
  return poses;
}

inline ToolPoses spinning(int count, const PoseErrors& errors, const ToolTruth& truth = {},
                          double most_rad = 2.6) {
  PoseNoise noise(errors);
  ToolPoses poses;
  const Eigen::Quaterniond first = leaning(0.3, -0.2);
  const Eigen::Vector3d held = first * truth.axis;
  for (int i = 0; i < count; ++i) {
    const Eigen::Quaterniond turn = Eigen::AngleAxisd(most_rad * std::sin(0.021 * i), held) * first;
    poses.push_back({i * Nanoseconds{4'166'667}, noise.disturbed({turn, truth.divot - turn * truth.tip})});
  }
  return poses;
}

}  // namespace linescope::calibrate
