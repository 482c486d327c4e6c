#include "acquire/twin/calibration_motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "acquire/twin/dice.hpp"

namespace linescope::twin {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kNearest = 10, kFarthest = 20, kShakeDistance = 17;  // mm
constexpr double kMostTilt = 0.61, kMostRoll = 0.7;                   // rad
constexpr double kPictureShare = 0.93;  // of the picture's half width or height that the corners may fill
constexpr double kSlopeOnCircle = 0.6;  // how far from the axis the round picture goes
const Vector3d kDivot{4, 22, 0};

/// Where the camera is: it looks at `aim` on the board from `distance` along the direction that is tilted by
/// `tilt` towards `azimuth`; then it is turned by `roll` about its own axis.
struct View {
  Vector2d aim{0, 0};
  double distance = 15, tilt = 0, azimuth = 0, roll = 0;
};

Rigid<PhantomFrame, CameraCv> camera_at(const View& view) {
  const Vector3d hinge(std::cos(view.azimuth), std::sin(view.azimuth), 0);
  Eigen::Matrix3d down;
  down << Vector3d::UnitY(), Vector3d::UnitX(), -Vector3d::UnitZ();
  const Quaterniond turn =
      AngleAxisd(view.tilt, hinge) * Quaterniond(down) * AngleAxisd(view.roll, Vector3d::UnitZ());
  return {turn, Vector3d(view.aim.x(), view.aim.y(), 0) - view.distance * (turn * Vector3d::UnitZ())};
}

bool sees(const Rigid<PhantomFrame, CameraCv>& phantom_from_camera, const LensNumbers& lens,
          const BoardPattern& pattern) {
  const auto camera_from_phantom = phantom_from_camera.inverse();
  const double x = 0.5 * pattern.rows * pattern.square_mm, y = 0.5 * pattern.columns * pattern.square_mm;
  for (const auto& [sx, sy] : {std::pair{-1, -1}, {-1, 1}, {1, -1}, {1, 1}}) {
    const Vector3d corner = camera_from_phantom * Vector3d(sx * x, sy * y, 0);
    const Vector2d slope = corner.head<2>() / corner.z();
    if (!(corner.z() > 5 && std::abs(slope.x()) < kPictureShare * 0.5 * lens.width / lens.fx &&
          std::abs(slope.y()) < kPictureShare * 0.5 * lens.height / lens.fy && slope.norm() < kSlopeOnCircle))
      return false;
  }
  return true;
}

double eased(double fraction) {
  const double f = std::clamp(fraction, 0.0, 1.0);
  return f * f * f * (f * (6 * f - 15) + 10);
}

double wave(double hertz, double seconds, double phase) {
  return std::sin(kTurn * hertz * seconds + phase);
}

/// The least tilts and distances always fit; a try that does not is made milder and milder.
Rigid<PhantomFrame, CameraCv> fitting_view(Dice& dice, int index, const LensNumbers& lens,
                                           const BoardPattern& pattern) {
  View view;
  view.distance = kNearest + (kFarthest - kNearest) * (index % 5 + dice.uniform()) / 5;
  view.tilt = kMostTilt * (0.35 + 0.65 * dice.uniform());
  view.azimuth = kTurn * 0.381966 * index;
  view.roll = kMostRoll * dice.uniform(-1, 1);
  view.aim = 5 * Vector2d(dice.uniform(-1, 1), dice.uniform(-1.4, 1.4));
  for (int milder = 0; milder < 60 && !sees(camera_at(view), lens, pattern); ++milder) {
    view.aim *= 0.85;
    if (milder < 8) continue;
    view.roll *= 0.9;
    if (milder > 16) view.tilt *= 0.95;
    if (milder > 30) view.distance *= 1.03;
  }
  return camera_at(view);
}

}  // namespace

CalibrationMotion::CalibrationMotion(std::uint64_t seed, const LensNumbers& lens,
                                     const BoardPattern& pattern) {
  Dice dice(seed, Stream::hand, 2000);
  for (int i = 0; i < kBoardViews; ++i) views_.push_back(fitting_view(dice, i, lens, pattern));
}

Rigid<PhantomFrame, CameraCv> CalibrationMotion::views(double seconds) const {
  const double step = kViewHoldSeconds + kViewMoveSeconds;
  const auto number = static_cast<std::size_t>(seconds / step);
  const double since = seconds - static_cast<double>(number) * step;
  const auto& here = views_[number % views_.size()];
  const auto& next = views_[(number + 1) % views_.size()];
  return interpolate(here, next, eased((since - kViewHoldSeconds) / kViewMoveSeconds));
}

Rigid<PhantomFrame, CameraCv> CalibrationMotion::shake(double seconds) const {
  const double s = seconds;
  const Quaterniond turn = AngleAxisd(0.05 * (wave(0.71, s, 0) + wave(1.63, s, 1)), Vector3d::UnitX()) *
                           AngleAxisd(0.05 * (wave(0.93, s, 2) + wave(1.37, s, 0)), Vector3d::UnitY()) *
                           AngleAxisd(0.10 * (wave(0.57, s, 1) + wave(1.19, s, 2)), Vector3d::UnitZ());
  const Vector3d shift(0.4 * wave(0.83, s, 0.5), 0.6 * wave(0.61, s, 1.5), 1.5 * wave(0.43, s, 2.5));
  const auto middle = camera_at({.distance = kShakeDistance, .tilt = 0.25, .azimuth = 0.8});
  return {middle.rotation() * turn, middle.translation() + shift};
}

HarvesterHold CalibrationMotion::pivot(double seconds) {
  const double lean_x = 0.5 * (wave(0.31, seconds, 0) + 0.4 * wave(0.53, seconds, 1));
  const double lean_y = 0.5 * (wave(0.23, seconds, 2) + 0.4 * wave(0.61, seconds, 0));
  return {kDivot, Vector3d(lean_x, lean_y, 1).normalized(), 0.5 * wave(0.17, seconds, 0)};
}

HarvesterHold CalibrationMotion::spin(double seconds) {
  constexpr double kMostSpin = 150 * std::numbers::pi / 180;
  return {kDivot, Vector3d(0.15, -0.1, 1).normalized(), kMostSpin * wave(1 / kSpinSeconds, seconds, 0)};
}

}  // namespace linescope::twin
