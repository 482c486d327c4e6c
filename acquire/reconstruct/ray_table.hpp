// The undistorted direction of every pixel, computed once per camera: undistortion becomes a look-up.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "acquire/laser/line_extractor_options.hpp"
#include "common/camera_model.hpp"

namespace linescope {

/// Direction (x, y, 1) in OpenCV's camera frame, and how it changes along a profile, per px.
struct Ray {
  float x = 0, y = 0;
  float x_step = 0, y_step = 0;
};

class RayTable {
 public:
  /// Undistorts width * height pixels: about a quarter of a microsecond each.
  explicit RayTable(const CameraModel& camera);

  /// Linear between pixels. NaN where the lens distortion cannot be inverted and outside of the picture, also
  /// for NaN input. A line's profile runs along v for ProfileAxis::column, along u for row.
  Ray at(float u, float v, ProfileAxis axis) const noexcept {
    const bool column = axis == ProfileAxis::column;
    const float along = column ? v : u, across = column ? u : v;
    const int last_along = column ? height_ - 1 : width_ - 1, last_across = column ? width_ - 1 : height_ - 1;
    // Negated, so that NaN is caught.
    if (!(along >= 0 && along <= static_cast<float>(last_along) && across >= 0 &&
          across <= static_cast<float>(last_across)))
      return outside();
    const int i = along >= static_cast<float>(last_along) ? last_along - 1 : static_cast<int>(along);
    const int k = static_cast<int>(across);
    const float part = along - static_cast<float>(i), rest = across - static_cast<float>(k);
    const std::ptrdiff_t step = column ? width_ : 1, next = column ? 1 : width_;
    const Direction* const d = directions_.data() + i * step + k * next;
    Ray ray = between(d[0], d[step], part);
    if (rest > 0) {
      const Ray other = between(d[next], d[next + step], part);
      ray = {mix(ray.x, other.x, rest), mix(ray.y, other.y, rest), ray.x_step, ray.y_step};
    }
    return ray;
  }

 private:
  struct Direction {
    float x, y;
  };
  static Ray outside() noexcept;
  static float mix(float a, float b, float part) noexcept { return a + part * (b - a); }
  static Ray between(Direction a, Direction b, float part) noexcept {
    return {mix(a.x, b.x, part), mix(a.y, b.y, part), b.x - a.x, b.y - a.y};
  }

  int width_, height_;
  std::vector<Direction> directions_;
};

}  // namespace linescope
