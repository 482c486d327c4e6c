#include "viewer/navigate/steady_harvester.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace linescope {
namespace {

/// Share of the new value after `seconds` at a cut-off frequency.
double share(double hz, double seconds) {
  const double turned = 2 * std::numbers::pi * hz * seconds;
  return turned / (1 + turned);
}

}  // namespace

Result<void> validate(const SteadyHarvesterOptions& o) {
  if (!(o.slowest_hz > 0 && o.speed_hz > 0 && std::isfinite(o.slowest_hz) && std::isfinite(o.speed_hz)))
    return fail(ErrorCode::invalid,
                fmt::format("steady harvester: cut-off frequencies {} and {} Hz must be positive",
                            o.slowest_hz, o.speed_hz));
  if (!(o.tip_hz_per_speed >= 0 && o.axis_hz_per_speed >= 0))
    return fail(ErrorCode::invalid,
                "steady harvester: growth of the cut-off with the speed must not be negative");
  if (o.longest_pause <= 0)
    return fail(ErrorCode::invalid, "steady harvester: longest pause must be positive");
  return {};
}

const SteadyHarvester::Hold& SteadyHarvester::follow(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis,
                                                     Nanoseconds time) {
  const Hold now{tip, axis.normalized()};
  if (last_ && time == *last_) return steady_;
  const bool follows = last_ && time > *last_ && time - *last_ <= options_.longest_pause &&
                       steady_.tip.allFinite() && steady_.axis.allFinite();
  if (!follows) {
    steady_ = sample_ = now;
    tip_speed_.setZero();
    axis_speed_.setZero();
    last_ = time;
    return steady_;
  }
  const double passed = seconds_from(time - *last_);
  const double speed_share = share(options_.speed_hz, passed);
  tip_speed_ += speed_share * ((now.tip - sample_.tip) / passed - tip_speed_);
  axis_speed_ += speed_share * ((now.axis - sample_.axis) / passed - axis_speed_);
  steady_.tip += share(options_.slowest_hz + options_.tip_hz_per_speed * tip_speed_.norm(), passed) *
                 (now.tip - steady_.tip);
  steady_.axis += share(options_.slowest_hz + options_.axis_hz_per_speed * axis_speed_.norm(), passed) *
                  (now.axis - steady_.axis);
  steady_.axis.normalize();
  sample_ = now;
  last_ = time;
  return steady_;
}

}  // namespace linescope
