// The thread that answers, with every new pose, by how much the harvester is off the surface's normal.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "viewer/view_state.hpp"

namespace linescope {

/// Which normal: the thesis's Algorithm 1, or the robust local fit with its 95 % interval.
enum class NormalChoice : std::uint8_t { algorithm_1, robust };
std::string name(NormalChoice choice);

class NavigationWorker {
 public:
  using Sink = std::function<void(std::shared_ptr<const NavigationView>)>;  ///< called in the worker's thread

  NavigationWorker(NormalChoice choice, Sink sink);
  ~NavigationWorker();

  /// Any thread, never waits for an estimate.
  void add(const LineNews& news);
  void set_poses(std::shared_ptr<const LiveView> live);
  void set_choice(NormalChoice choice);

 private:
  struct Work;
  void run(const std::stop_token& stop);

  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::vector<LineNews> inbox_;
  std::shared_ptr<const LiveView> live_;
  NormalChoice choice_;
  bool something_ = false;
  Sink sink_;
  std::unique_ptr<Work> work_;
  std::jthread thread_;
};

/// The harvester's tip and axis in the held frame at the poses of `live`; nothing when a pose or the
/// calibration that they need is not usable. Exposed for tests and for the scene, which draws the harvester
/// at the same place.
struct HeldHarvester {
  Eigen::Vector3d tip, axis;  ///< axis: unit, from the tip to the handle
};
std::optional<HeldHarvester> held_harvester(const LiveView& live);

/// The same at the last known poses, however old: for the ghost of a tool that was lost.
std::optional<HeldHarvester> last_known_harvester(const LiveView& live);

}  // namespace linescope
