// The undistorted direction of every pixel, computed once per camera: undistortion becomes a look-up.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <limits>
#include <vector>

#include "acquire/laser/line_extractor_options.hpp"
#include "common/camera_model.hpp"

namespace linescope {

/// Direction (x, y, 1) in OpenCV's camera frame, and how it changes along a profile, per px.
struct Ray {
  float x = 0, y = 0;
  float x_step = 0, y_step = 0;
};

/// Direction (x, y, 1) in OpenCV's camera frame.
struct RayDirection {
  float x, y;
};

/// A RayTable as the profiles of one axis run through it. Copied freely; the table must outlive it.
class RayProfiles {
 public:
  /// `directions`: width * height of them, row after row. A line's profile runs along v for
  /// ProfileAxis::column, along u for row.
  RayProfiles(const RayDirection* directions, int width, int height, ProfileAxis axis)
      : directions_(directions),
        column_(axis == ProfileAxis::column),
        step_(column_ ? width : 1),
        next_(column_ ? 1 : width),
        most_((column_ ? height : width) - 2),
        last_along_(static_cast<float>(most_ + 1)),
        last_across_(static_cast<float>((column_ ? width : height) - 1)) {}

  /// Linear between pixels. NaN where the lens distortion cannot be inverted and outside of the picture, also
  /// for NaN input.
  Ray at(float u, float v) const noexcept {
    const float along = column_ ? v : u, across = column_ ? u : v;
    if (!(along >= 0 && along <= last_along_ && across >= 0 && across <= last_across_))  // also NaN
      return {kNowhere, kNowhere, kNowhere, kNowhere};
    const int i = std::min(static_cast<int>(along), most_), k = static_cast<int>(across);
    const float part = along - static_cast<float>(i), rest = across - static_cast<float>(k);
    const RayDirection* const d = directions_ + i * step_ + k * next_;
    Ray ray = between(d[0], d[step_], part);
    if (rest > 0) {
      const Ray other = between(d[next_], d[next_ + step_], part);
      ray = {mix(ray.x, other.x, rest), mix(ray.y, other.y, rest), ray.x_step, ray.y_step};
    }
    return ray;
  }

 private:
  static constexpr float kNowhere = std::numeric_limits<float>::quiet_NaN();
  static float mix(float a, float b, float part) noexcept { return a + part * (b - a); }
  static Ray between(RayDirection a, RayDirection b, float part) noexcept {
    return {mix(a.x, b.x, part), mix(a.y, b.y, part), b.x - a.x, b.y - a.y};
  }

  const RayDirection* directions_;
  bool column_;
  std::ptrdiff_t step_, next_;      // from a pixel to the next of its profile, and to the next profile
  int most_;                        // the last pixel but one of a profile
  float last_along_, last_across_;  // px
};

class RayTable {
 public:
  /// Undistorts width * height pixels: about a quarter of a microsecond each.
  explicit RayTable(const CameraModel& camera);

  RayProfiles along(ProfileAxis axis) const { return {directions_.data(), width_, height_, axis}; }

 private:
  int width_, height_;
  std::vector<RayDirection> directions_;
};

}  // namespace linescope
