// The thread that makes the surface: lines in, mesh and grid out, at its own pace. Nobody waits for it.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "viewer/surface/mesher_options.hpp"
#include "viewer/view_state.hpp"

namespace linescope {

/// For people: "proposed marching cubes" and the like.
std::string name(MeshMethod method);

class SurfaceWorker {
 public:
  using Sink = std::function<void(std::shared_ptr<const SurfaceView>)>;  ///< called in the worker's thread

  /// Precondition: validate(options) is good.
  SurfaceWorker(const MesherOptions& options, Sink sink);
  /// Ends the thread; a mesh being made is finished first.
  ~SurfaceWorker();

  /// Any thread, never waits for a mesh.
  void add(const LineNews& news);
  /// Makes the surface anew with other options, from all lines. Bad options: the former surface stays and
  /// SurfaceView::fault says why.
  void set_options(const MesherOptions& options);
  /// How much of the surface with other options is made, 0..1; nothing: none is being made. Any thread.
  std::optional<double> changing() const;
  /// The surface and the options of before set_options stay, if it is still going on. Any thread.
  void give_up_change() { give_up_ = true; }

 private:
  struct Work;
  static constexpr double kNotChanging = -1;
  void change(const MesherOptions& wanted);
  std::shared_ptr<const SurfaceView> make_and_settle();
  void run(const std::stop_token& stop);

  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::vector<LineNews> inbox_;
  std::unique_ptr<MesherOptions> new_options_;
  std::atomic<double> change_share_{kNotChanging};
  std::atomic<bool> give_up_{false};
  Sink sink_;
  std::unique_ptr<Work> work_;
  std::jthread thread_;
};

}  // namespace linescope
