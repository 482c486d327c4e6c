#include "acquire/twin/timeline.hpp"

#include <cmath>

#include "acquire/twin/calibration_motion.hpp"

namespace linescope::twin {
namespace {

constexpr double kApproachSeconds = 0.8;
constexpr double kTravelSeconds = 1.2;
constexpr double kHoldSeconds = 1.0;
constexpr double kEndlessSeconds = 1e6;  // motions that never repeat themselves

}  // namespace

Timeline::Timeline(const HandOptions& options) {
  switch (options.scenario) {
    case Scenario::demo:
      add(Phase::approach, kApproachSeconds);
      add(Phase::sweep, options.sweep_seconds * options.sweeps);
      add(Phase::withdraw, kApproachSeconds);
      add_spots(options);
      break;
    case Scenario::sweeps:
      add(Phase::sweep, 2 * options.sweep_seconds);
      break;
    case Scenario::spots:
      add_spots(options);
      break;
    case Scenario::still:
      add(Phase::stand, 1.0);
      break;
    case Scenario::board:
      add(Phase::board, kBoardViews * (kViewHoldSeconds + kViewMoveSeconds));
      break;
    case Scenario::shake:
      add(Phase::shake, kEndlessSeconds);
      break;
    case Scenario::pivot:
      add(Phase::pivot, kEndlessSeconds);
      break;
    case Scenario::spin:
      add(Phase::spin, kSpinSeconds);
      break;
  }
}

void Timeline::add(Phase phase, double seconds, int spot) {
  phases_.push_back({phase, 0, seconds, spot});
  total_ += seconds;
}

void Timeline::add_spots(const HandOptions& options) {
  for (int spot = 0; spot < options.spots; ++spot) {
    add(Phase::travel, kTravelSeconds, spot);
    add(Phase::tilt, options.tilt_seconds, spot);
    add(Phase::hold, kHoldSeconds, spot);
  }
  if (options.spots > 0) add(Phase::leave, kTravelSeconds, options.spots - 1);
}

Moment Timeline::at(double seconds) const {
  double rest = std::fmod(seconds, total_);
  for (const Moment& phase : phases_) {
    if (rest < phase.length) {
      Moment found = phase;
      found.since = rest;
      return found;
    }
    rest -= phase.length;
  }
  Moment last = phases_.back();
  last.since = last.length;
  return last;
}

}  // namespace linescope::twin
