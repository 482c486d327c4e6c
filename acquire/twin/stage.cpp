#include "acquire/twin/stage.hpp"

#include <cmath>
#include <numbers>

#include "acquire/twin/dice.hpp"

namespace linescope::twin {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kDriftHz = 0.07;

Rigid<World, PhantomFrame> resting_place() {
  // Half a turn about x makes the site face the transmitter's -z (up); then nothing is left parallel to an
  // axis.
  const Quaterniond up(AngleAxisd(std::numbers::pi, Vector3d::UnitX()));
  const Quaterniond turn = AngleAxisd(0.4, Vector3d::UnitZ()) * AngleAxisd(-0.15, Vector3d::UnitY()) *
                           AngleAxisd(0.2, Vector3d::UnitX());
  return {turn * up, Vector3d(330, 45, 60)};
}

}  // namespace

Stage::Stage(std::uint64_t seed, const HandOptions& options)
    : object_from_phantom_(Quaterniond(AngleAxisd(0.7, Vector3d(0.3, -0.5, 0.8).normalized())),
                           Vector3d(38, -21, 17)),
      world_from_resting_phantom_(resting_place()),
      drift_mm_(options.object_drift_mm),
      drift_rad_(options.object_drift_rad) {
  Dice dice(seed, Stream::hand, 1000);
  for (int i = 0; i < 3; ++i) drift_phase_[i] = dice.uniform(0, 2 * std::numbers::pi);
}

Rigid<World, Object> Stage::world_from_object(double seconds) const {
  const auto resting = world_from_resting_phantom_ * object_from_phantom_.inverse();
  // Zero at the beginning, so that the hand's plan starts out right.
  Vector3d sway;
  for (int i = 0; i < 3; ++i) {
    const double turn = 2 * std::numbers::pi * kDriftHz * (1 + 0.3 * i) * seconds;
    sway[i] = std::sin(turn + drift_phase_[i]) - std::sin(drift_phase_[i]);
  }
  const Quaterniond turned(AngleAxisd(drift_rad_ * sway.x(), Vector3d(0.2, 0.9, -0.4).normalized()));
  return {turned * resting.rotation(), resting.translation() + drift_mm_ * sway};
}

}  // namespace linescope::twin
