#include "acquire/twin/twin_truth.hpp"

#include <algorithm>
#include <cmath>

#include "acquire/twin/board_phantom.hpp"
#include "acquire/twin/hand_motion.hpp"
#include "acquire/twin/phantom.hpp"
#include "acquire/twin/stage.hpp"

namespace linescope::twin {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

// Sensor 3 is turned so that its axis lies along `axis`; the turn about the axis is the least one, and the
// spin.
Rigid<World, Harvester> pose_from_hold(const HarvesterTruth& hold, const InstrumentOptions& instrument) {
  const Quaterniond turn = Eigen::AngleAxisd(hold.spin_rad, hold.axis) *
                           Quaterniond::FromTwoVectors(instrument.harvester_axis, hold.axis);
  return {turn, hold.tip - turn * instrument.harvester_tip};
}

}  // namespace

TwinTruth::TwinTruth(const TwinOptions& options, std::shared_ptr<const Phantom> phantom)
    : options_(options),
      phantom_(std::move(phantom)),
      stage_(std::make_shared<Stage>(options.seed, options.hand)),
      hand_(std::make_shared<HandMotion>(options, *phantom_)) {
  const auto object_from_phantom = stage_->object_from_phantom();
  for (const SpotOnPhantom& spot : hand_->spots()) {
    spots_.push_back({object_from_phantom * spot.position, object_from_phantom.rotate(spot.normal)});
  }
}

double TwinTruth::seconds(Nanoseconds time) const {
  return std::max(0.0, seconds_from(time - options_.start));
}

double TwinTruth::distance(const Vector3d& point_object) const {
  return phantom_->distance(stage_->object_from_phantom().inverse() * point_object);
}

Vector3d TwinTruth::normal(const Vector3d& point_object) const {
  const auto object_from_phantom = stage_->object_from_phantom();
  return object_from_phantom.rotate(phantom_->normal(object_from_phantom.inverse() * point_object));
}

Rigid<World, Object> TwinTruth::world_from_object(Nanoseconds time) const {
  return stage_->world_from_object(seconds(time));
}

Rigid<World, CameraCv> TwinTruth::world_from_camera(Nanoseconds time) const {
  return stage_->world_from_resting_phantom() * hand_->phantom_from_camera(seconds(time));
}

Rigid<World, Endoscope> TwinTruth::world_from_endoscope(Nanoseconds time) const {
  return world_from_camera(time) * options_.instrument.endoscope_from_camera.inverse();
}

Rigid<PhantomFrame, CameraCv> TwinTruth::phantom_from_camera(Nanoseconds time) const {
  const auto world_from_phantom = world_from_object(time) * stage_->object_from_phantom();
  return world_from_phantom.inverse() * world_from_camera(time);
}

Rigid<World, Board> TwinTruth::world_from_board(Nanoseconds time) const {
  return world_from_object(time) * stage_->object_from_phantom() * phantom_from_board(options_.phantom.board);
}

HarvesterTruth TwinTruth::harvester(Nanoseconds time) const {
  const HarvesterHold hold = hand_->harvester(seconds(time));
  const auto world_from_phantom = world_from_object(time) * stage_->object_from_phantom();
  HarvesterTruth truth;
  truth.tip = world_from_phantom * hold.tip;
  truth.axis = world_from_phantom.rotate(hold.axis);
  truth.spin_rad = hold.spin_rad;
  const Moment moment = hand_->moment(seconds(time));
  if (moment.phase != Phase::tilt && moment.phase != Phase::hold) return truth;
  truth.spot = moment.spot;
  const Vector3d& normal = hand_->spots()[static_cast<std::size_t>(moment.spot)].normal;
  truth.angle_to_normal_rad = std::atan2(hold.axis.cross(normal).norm(), hold.axis.dot(normal));
  return truth;
}

Rigid<World, Harvester> TwinTruth::world_from_harvester(Nanoseconds time) const {
  return pose_from_hold(harvester(time), options_.instrument);
}

bool TwinTruth::scanning(Nanoseconds time) const {
  return twin::scanning(hand_->moment(seconds(time)).phase);
}

}  // namespace linescope::twin
