#include "acquire/twin/hand_motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "acquire/twin/dice.hpp"

namespace linescope::twin {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kMargin = 1.5;  // mm the sweep goes beyond the site
constexpr double kHover = 35;    // mm, harvester above a spot between spots
constexpr double kGapHz = 0.23;
constexpr double kTipTremor = 0.03;    // mm; the tip rests on the bone
constexpr double kAxisTremor = 0.004;  // rad
constexpr double kProppedHand = 0.2;   // of its unsteadiness is left at the views of the board
constexpr double kFixtureSlip = 0.2;   // of both, where divot or bushing hold the tool

double smooth(double fraction) {
  const double f = std::clamp(fraction, 0.0, 1.0);
  return f * f * f * (f * (6 * f - 15) + 10);
}

Quaterniond small_rotation(const Vector3d& vector) {
  const double angle = vector.norm();
  return angle > 0 ? Quaterniond(AngleAxisd(angle, vector / angle)) : Quaterniond::Identity();
}

// The camera looks along -normal; its x axis, along which the line runs, lies across the site (phantom y).
Rigid<PhantomFrame, CameraCv> looking_down(const Vector3d& eye, const Vector3d& normal) {
  Eigen::Matrix3d axes;
  axes.col(2) = -normal;
  axes.col(0) = Vector3d::UnitY();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return {Quaterniond(axes), eye};
}

// Lifted and turned away: nothing of the phantom is in the picture.
Rigid<PhantomFrame, CameraCv> resting_camera() {
  const auto down = looking_down({-30, 20, 90}, Vector3d::UnitZ());
  return down * Rigid<CameraCv, CameraCv>(Quaterniond(AngleAxisd(2.6, Vector3d::UnitX())), Vector3d::Zero());
}

std::vector<SpotOnPhantom> choose_spots(const TwinOptions& options, const Phantom& phantom) {
  Dice dice(options.seed, Stream::spots);
  std::vector<SpotOnPhantom> spots;
  const int count = options.hand.spots;
  for (int i = 0; i < count; ++i) {
    const double along = count > 1 ? 2.0 * i / (count - 1) - 1 : 0.0;
    const double x = 0.36 * options.phantom.site_length_mm * along;
    const double y = 0.25 * options.phantom.site_width_mm * dice.uniform(-1, 1);
    Hit hit;
    if (!phantom.cast({x, y, 200}, {0, 0, -1}, hit)) continue;
    const Vector3d position{x, y, 200 - hit.distance};
    spots.push_back({position, phantom.normal(position)});
  }
  return spots;
}

}  // namespace

HandMotion::HandMotion(const TwinOptions& options, const Phantom& phantom)
    : options_(options),
      timeline_(options.hand),
      profile_(phantom, 0.5 * options.phantom.site_length_mm + 4),
      calibration_(options.seed, options.instrument.lens, options.phantom.board),
      spots_(choose_spots(options, phantom)),
      position_tremor_(options.seed, 1, options.hand.tremor_mm, options.hand.wander_mm),
      rotation_tremor_(options.seed, 2, options.hand.tremor_rad, options.hand.wander_rad),
      tip_tremor_(options.seed, 3, kTipTremor, kTipTremor),
      axis_tremor_(options.seed, 4, kAxisTremor, 0),
      line_ahead_mm_(options.instrument.baseline_mm -
                     options.hand.gap_mm * std::tan(options.instrument.alpha_rad)) {
  Dice dice(options.seed, Stream::hand, 5);
  gap_phase_ = dice.uniform(0, kTurn);
  for (std::size_t i = 0; i < spots_.size(); ++i) tilt_azimuth_.push_back(dice.uniform(0, kTurn));
}

Rigid<PhantomFrame, CameraCv> HandMotion::over_site(double way, double gap) const {
  const Vector3d normal = profile_.normal(way);
  return looking_down(Vector3d(way, 0, profile_.height(way)) + gap * normal, normal);
}

double HandMotion::sweep_position(double sweep_seconds) const {
  const double half = 0.5 * options_.phantom.site_length_mm + kMargin;
  const double way = sweep_seconds / options_.hand.sweep_seconds;
  const double part = way - std::floor(way);
  // Slower at both ends, where the hand turns round, and nowhere at rest in between.
  const double eased = part - std::sin(kTurn * part) / kTurn * 0.7;
  const bool forward = static_cast<long long>(std::floor(way)) % 2 == 0;
  // The line runs beside the optical axis (towards -x): the eye goes that much further.
  return (forward ? 2 * eased - 1 : 1 - 2 * eased) * half + line_ahead_mm_;
}

double HandMotion::gap_at(double seconds) const {
  const HandOptions& hand = options_.hand;
  return hand.gap_mm + hand.gap_variation_mm * std::sin(kTurn * kGapHz * seconds + gap_phase_);
}

Rigid<PhantomFrame, CameraCv> HandMotion::planned_camera(const Moment& moment, double seconds) const {
  const HandOptions& hand = options_.hand;
  switch (moment.phase) {
    case Phase::stand:
      return over_site(0, hand.gap_mm);
    case Phase::sweep:
      return over_site(sweep_position(moment.since), gap_at(seconds));
    case Phase::approach:
      return interpolate(resting_camera(), over_site(sweep_position(0), gap_at(seconds)),
                         smooth(moment.fraction()));
    case Phase::withdraw: {
      const double end = hand.sweeps * hand.sweep_seconds;
      return interpolate(over_site(sweep_position(end), gap_at(seconds)), resting_camera(),
                         smooth(moment.fraction()));
    }
    case Phase::board:
      return calibration_.views(moment.since);
    case Phase::shake:
      return calibration_.shake(moment.since);
    default:
      return resting_camera();
  }
}

Rigid<PhantomFrame, CameraCv> HandMotion::phantom_from_camera(double seconds) const {
  const Moment now = timeline_.at(seconds);
  const auto planned = planned_camera(now, seconds);
  if (now.phase == Phase::stand) return planned;
  const double share = now.phase == Phase::board ? kProppedHand : 1;
  return {planned.rotation() * small_rotation(share * rotation_tremor_.at(seconds)),
          planned.translation() + share * position_tremor_.at(seconds)};
}

HarvesterHold HandMotion::on_spot(int spot, double tilt) const {
  const SpotOnPhantom& at = spots_[static_cast<std::size_t>(spot)];
  const double azimuth = tilt_azimuth_[static_cast<std::size_t>(spot)];
  const Vector3d across = at.normal.unitOrthogonal();
  const Vector3d hinge = AngleAxisd(azimuth, at.normal) * across;
  return {at.position, AngleAxisd(tilt, hinge) * at.normal, 0};
}

HarvesterHold HandMotion::hovering(int spot) const {
  if (spot < 0) return {Vector3d(60, -50, 70), Vector3d(0.3, -0.2, 1).normalized(), 0};
  HarvesterHold hold = on_spot(spot, options_.hand.tilt_start_rad * 1.6);
  hold.tip += kHover * hold.axis;
  return hold;
}

HarvesterHold HandMotion::planned_harvester(const Moment& moment) const {
  const HandOptions& hand = options_.hand;
  const auto blend = [](const HarvesterHold& a, const HarvesterHold& b, double f) {
    return HarvesterHold{a.tip + f * (b.tip - a.tip), (a.axis + f * (b.axis - a.axis)).normalized(), 0};
  };
  const double way = smooth(moment.fraction());
  switch (moment.phase) {
    case Phase::travel: {
      // Two halves through a place above the spot, so that the tip does not cut through the bone.
      const HarvesterHold above = hovering(moment.spot);
      if (moment.fraction() < 0.5) {
        const HarvesterHold from =
            moment.spot > 0 ? on_spot(moment.spot - 1, hand.tilt_end_rad) : hovering(-1);
        return blend(from, above, smooth(2 * moment.fraction()));
      }
      return blend(above, on_spot(moment.spot, hand.tilt_start_rad), smooth(2 * moment.fraction() - 1));
    }
    case Phase::tilt:
      return on_spot(moment.spot, hand.tilt_start_rad + way * (hand.tilt_end_rad - hand.tilt_start_rad));
    case Phase::hold:
      return on_spot(moment.spot, hand.tilt_end_rad);
    case Phase::leave:
      return blend(on_spot(moment.spot, hand.tilt_end_rad), hovering(-1), way);
    case Phase::pivot:
      return CalibrationMotion::pivot(moment.since);
    case Phase::spin:
      return CalibrationMotion::spin(moment.since);
    default:
      return hovering(-1);
  }
}

HarvesterHold HandMotion::harvester(double seconds) const {
  const Moment now = timeline_.at(seconds);
  HarvesterHold hold = planned_harvester(now);
  const double slip = now.phase == Phase::pivot || now.phase == Phase::spin ? kFixtureSlip : 1;
  hold.tip += slip * tip_tremor_.at(seconds);
  hold.axis = small_rotation(slip * axis_tremor_.at(seconds)) * hold.axis;
  return hold;
}

}  // namespace linescope::twin
