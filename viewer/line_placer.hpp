// From the line's world coordinates to the frame the surface is held in, at the poses of the line's own
// instant.
#pragma once

#include <memory>
#include <span>
#include <tl/expected.hpp>

#include "ipc/segment_types.hpp"
#include "viewer/view_state.hpp"

namespace linescope {

class LinePlacer {
 public:
  explicit LinePlacer(HeldIn held_in) : held_in_(held_in) {}

  /// Where the camera is on the endoscope; identity until the daemon's calibration is known.
  void set_camera(const Rigid<Endoscope, CameraCv>& endoscope_from_camera) {
    endoscope_from_camera_ = endoscope_from_camera;
  }

  /// The line in the held frame, or the state of the object's pose that forbids it: a line is never placed by
  /// guess.
  tl::expected<std::shared_ptr<const HeldLine>, ToolState> place(
      const Line& line, std::span<const SurfacePoint> world_points) const;

  /// Median depth of the points in front of the camera, mm; 0 when the line has none.
  double gap(const Line& line, std::span<const SurfacePoint> world_points) const;

 private:
  Rigid<World, CameraCv> world_from_camera(const Line& line) const;

  HeldIn held_in_;
  Rigid<Endoscope, CameraCv> endoscope_from_camera_;
};

}  // namespace linescope
