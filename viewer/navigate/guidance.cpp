#include "viewer/navigate/guidance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace linescope {
namespace {

std::optional<double> if_finite(double value) {
  return std::isfinite(value) ? std::optional<double>(value) : std::nullopt;
}

}  // namespace

Result<void> validate(const GuidanceOptions& o) {
  if (!(o.angle_tolerance > 0 && o.angle_tolerance <= std::numbers::pi / 2))
    return fail(
        ErrorCode::invalid,
        fmt::format("guidance: angle tolerance {} rad is not within 0 and 90 degrees", o.angle_tolerance));
  if (!(o.distance_tolerance > 0))
    return fail(ErrorCode::invalid,
                fmt::format("guidance: distance tolerance {} mm must be positive", o.distance_tolerance));
  if (o.hold < 0 || o.longest_pause < 0)
    return fail(ErrorCode::invalid, "guidance: hold time and longest pause must not be negative");
  if (!(o.angle_slack >= 0 && o.distance_slack >= 0 && o.angle_dead_band >= 0 && o.distance_dead_band >= 0))
    return fail(ErrorCode::invalid, "guidance: slacks and dead-bands must not be negative");
  return {};
}

std::optional<double> DeadBand::follow(std::optional<double> value) {
  if (!value || !shown_ || std::abs(*value - *shown_) > band_) shown_ = value;
  return shown_;
}

Guidance::Guidance(const GuidanceOptions& options)
    : options_(options),
      angle_(options.angle_dead_band),
      distance_(options.distance_dead_band),
      depth_(options.distance_dead_band) {}

const GuidanceState& Guidance::update(const NormalEstimate& estimate, Nanoseconds now) {
  if (!estimate.good() || !std::isfinite(estimate.angle)) return blank(now);
  state_.angle = angle_.follow(estimate.angle);
  state_.distance = distance_.follow(if_finite(estimate.distance));
  state_.depth = depth_.follow(if_finite(estimate.depth));
  // The decision takes the estimate itself, not the number on the screen, which lags by the dead-band.
  const double angle_limit = options_.angle_tolerance + (state_.within ? options_.angle_slack : 0);
  const double distance_limit = options_.distance_tolerance + (state_.within ? options_.distance_slack : 0);
  follow_hold(true, estimate.angle <= angle_limit && std::abs(estimate.distance) <= distance_limit, now);
  return state_;
}

const GuidanceState& Guidance::blank(Nanoseconds now) {
  state_.angle = angle_.follow(std::nullopt);
  state_.distance = distance_.follow(std::nullopt);
  state_.depth = depth_.follow(std::nullopt);
  follow_hold(false, false, now);
  return state_;
}

void Guidance::follow_hold(bool good, bool inside, Nanoseconds now) {
  now = std::max(now, last_);
  last_ = now;
  // A short pause keeps the start of the hold, but nothing is reported as held while there is no number.
  if (within_since_ && now - last_good_ > options_.longest_pause) within_since_.reset();
  if (good) {
    last_good_ = now;
    if (!inside)
      within_since_.reset();
    else if (!within_since_)
      within_since_ = now;
  }
  state_.within = good && inside;
  state_.held = state_.within && now - *within_since_ >= options_.hold;
  state_.held_share = !state_.within ? 0
                      : options_.hold == 0
                          ? 1
                          : std::min(1.0, seconds_from(now - *within_since_) / seconds_from(options_.hold));
}

}  // namespace linescope
