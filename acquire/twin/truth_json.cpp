#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "acquire/twin/hand_motion.hpp"
#include "acquire/twin/stage.hpp"
#include "acquire/twin/twin_truth.hpp"

namespace linescope::twin {
namespace {

using Eigen::Vector3d;

std::string json_vector(const Vector3d& v) {
  return fmt::format("[{},{},{}]", v.x(), v.y(), v.z());
}

template <class To, class From>
std::string json_pose(const Rigid<To, From>& pose) {
  const Eigen::Quaterniond& q = pose.rotation();
  return fmt::format(R"({{"wxyz":[{},{},{},{}],"mm":{}}})", q.w(), q.x(), q.y(), q.z(),
                     json_vector(pose.translation()));
}

std::string json_spots(const std::vector<MarkedSpot>& spots) {
  std::string list;
  for (const MarkedSpot& spot : spots) {
    list += fmt::format(R"({}{{"position_mm":{},"normal":{}}})", list.empty() ? "" : ",",
                        json_vector(spot.position), json_vector(spot.normal));
  }
  return list;
}

std::string json_instrument(const InstrumentOptions& i) {
  const LensNumbers& l = i.lens;
  return fmt::format(
      R"({{"width":{},"height":{},"fx":{},"fy":{},"cx":{},"cy":{},"distortion":[{}],"baseline_mm":{},"alpha_rad":{},)"
      R"("endoscope_from_camera":{},"harvester_tip_mm":{},"harvester_axis":{}}})",
      l.width, l.height, l.fx, l.fy, l.cx, l.cy, fmt::join(l.distortion, ","), i.baseline_mm, i.alpha_rad,
      json_pose(i.endoscope_from_camera), json_vector(i.harvester_tip), json_vector(i.harvester_axis));
}

std::string json_instant(const TwinTruth& truth, Nanoseconds start, Nanoseconds time) {
  const HarvesterTruth harvester = truth.harvester(time);
  return fmt::format(
      R"({{"time_ns":{},"world_from_endoscope":{},"world_from_object":{},"world_from_harvester":{},"scanning":{},)"
      R"("spot":{},"angle_to_normal_rad":{}}})",
      time - start, json_pose(truth.world_from_endoscope(time)), json_pose(truth.world_from_object(time)),
      json_pose(truth.world_from_harvester(time)), truth.scanning(time), harvester.spot,
      harvester.spot < 0 ? "null" : fmt::format("{}", harvester.angle_to_normal_rad));
}

}  // namespace

std::string TwinTruth::json(Nanoseconds duration, double poses_per_second) const {
  std::string instants;
  const auto step = static_cast<Nanoseconds>(std::llround(1e9 / poses_per_second));
  for (Nanoseconds t = 0; t <= duration; t += step) {
    instants += (instants.empty() ? "" : ",\n") + json_instant(*this, options_.start, options_.start + t);
  }
  return fmt::format(
      "{{\"seed\":{},\n\"phantom\":{},\n\"object_from_phantom\":{},\n\"instrument\":{},\n\"spots\":[{}],\n"
      "\"instants\":[\n{}]}}\n",
      options_.seed, phantom_->json(), json_pose(stage_->object_from_phantom()),
      json_instrument(options_.instrument), json_spots(spots_), instants);
}

}  // namespace linescope::twin
