#include "acquire/reconstruct/ray_table.hpp"

namespace linescope {

RayTable::RayTable(const CameraModel& camera) : width_(camera.width), height_(camera.height) {
  directions_.reserve(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  for (int v = 0; v < height_; ++v) {
    for (int u = 0; u < width_; ++u) {
      const Eigen::Vector2f d = camera.normalised_from_pixel({u, v}).cast<float>();
      directions_.push_back({d.x(), d.y()});
    }
  }
}

}  // namespace linescope
