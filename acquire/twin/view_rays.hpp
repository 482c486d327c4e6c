// The ray in the medium that belongs to each pixel: lens, and the flat window in front of it when that
// refracts.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "acquire/twin/instrument_options.hpp"
#include "acquire/twin/optics_options.hpp"

namespace linescope::twin {

/// In the camera's frame (OpenCV: y down, z forward), mm. The frame's origin is where the pupil appears to
/// be, seen from the medium through the window's middle.
struct ViewRay {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;  ///< unit; zero when no light reaches this pixel
  bool lit() const { return direction.z() > 0; }
};

/// The ray of any place in the picture.
class ViewRays {
 public:
  ViewRays(const LensNumbers& lens, const PortOptions& port, double medium_index);

  ViewRay at(double u, double v) const;

 private:
  ViewRay through_port(const Eigen::Vector2d& slope) const;

  LensNumbers lens_;  ///< with refraction: as it would be without water and window
  PortOptions port_;
  double medium_index_;
};

/// All pixels of a picture, row by row, computed once.
class RayTable {
 public:
  RayTable(const ViewRays& rays, int width, int height);

  const ViewRay& at(int u, int v) const { return rays_[static_cast<std::size_t>(v * width_ + u)]; }

 private:
  int width_;
  std::vector<ViewRay> rays_;
};

}  // namespace linescope::twin
