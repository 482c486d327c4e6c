// From a stream of estimates to what the operator sees: numbers that do not flicker, and "held" when it is
// good long enough.
#pragma once

#include <optional>

#include "common/result.hpp"
#include "common/time.hpp"
#include "viewer/navigate/normal_estimate.hpp"

namespace linescope {

struct GuidanceOptions {
  double angle_tolerance = 0.0523599;     ///< rad (3 degrees)
  double distance_tolerance = 1.0;        ///< tip from surface, mm, either side
  Nanoseconds hold = 500 * kMillisecond;  ///< within both for this long: held
  double angle_slack = 0.0052360;  ///< once within, leaves only beyond tolerance plus this, rad (0.3 degrees)
  double distance_slack = 0.2;     ///< mm
  double angle_dead_band =
      0.0034907;  ///< the shown angle stays until the true one is farther off than this, rad
  double distance_dead_band = 0.1;                 ///< mm
  Nanoseconds longest_pause = 100 * kMillisecond;  ///< a longer time without a good estimate ends the hold
};

/// The first fault, in one sentence.
Result<void> validate(const GuidanceOptions& options);

struct GuidanceState {
  std::optional<double> angle;     ///< to show, rad; nothing: blank
  std::optional<double> distance;  ///< to show, mm
  std::optional<double> depth;     ///< to show, mm
  bool within = false;             ///< both tolerances met, with slack
  double held_share = 0;           ///< 0 .. 1 of the hold time
  bool held = false;               ///< within for the whole hold time
};

/// A number that follows its input only when that has moved farther than the band, and goes blank with it.
class DeadBand {
 public:
  explicit DeadBand(double band) : band_(band) {}
  std::optional<double> follow(std::optional<double> value);

 private:
  double band_;
  std::optional<double> shown_;
};

/// One thread. Times must not go back; a time that does counts as the last one.
class Guidance {
 public:
  /// Precondition: validate(options) is good.
  explicit Guidance(const GuidanceOptions& options = {});

  /// `estimate` of instant `now`; one that is not good blanks the numbers at once.
  const GuidanceState& update(const NormalEstimate& estimate, Nanoseconds now);

  /// Nothing to go by (a tool is stale or lost): blanks the numbers; the hold ends after `longest_pause`.
  const GuidanceState& blank(Nanoseconds now);

  const GuidanceState& state() const { return state_; }

 private:
  void follow_hold(bool good, bool inside, Nanoseconds now);

  GuidanceOptions options_;
  DeadBand angle_, distance_, depth_;
  std::optional<Nanoseconds> within_since_;
  Nanoseconds last_good_ = 0;
  Nanoseconds last_ = 0;
  GuidanceState state_;
};

}  // namespace linescope
