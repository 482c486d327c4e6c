// The segments around one place in a frame of their own: z out of the surface, x and y in its tangent plane.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>

#include "viewer/navigate/live_index.hpp"

namespace linescope {

/// Orthonormal frame at a point of the surface; object's frame outside, local inside.
class PatchFrame {
 public:
  PatchFrame() = default;
  PatchFrame(const Eigen::Vector3d& origin, const Eigen::Vector3d& out);

  Eigen::Vector3d point_in(const Eigen::Vector3d& p) const { return axes_.transpose() * (p - origin_); }
  Eigen::Vector3d direction_in(const Eigen::Vector3d& d) const { return axes_.transpose() * d; }
  Eigen::Vector3d point_out(const Eigen::Vector3d& p) const { return axes_ * p + origin_; }
  Eigen::Vector3d direction_out(const Eigen::Vector3d& d) const { return axes_ * d; }
  const Eigen::Matrix3d& axes() const { return axes_; }
  const Eigen::Vector3d& origin() const { return origin_; }

 private:
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d axes_ = Eigen::Matrix3d::Identity();
};

/// One line's part in a patch.
struct PatchLine {
  std::uint32_t place = 0;  ///< in the index
  Nanoseconds time = 0;
  Eigen::Vector2f direction =
      Eigen::Vector2f::Zero();                      ///< in the tangent plane, sum over its segments, not unit
  Eigen::Vector2f shear = Eigen::Vector2f::Zero();  ///< sideways move per height of an error along the view
};

/// Fixed room, nothing allocated; arrays run over segments.
struct Patch {
  static constexpr int kMostSegments = 768;
  static constexpr int kMostLines = 256;
  using Row = std::array<float, kMostSegments>;

  PatchFrame frame;
  double radius = 0;
  int size = 0;
  int line_count = 0;
  int left_over = 0;  ///< segments that found no room (the oldest of each cell)
  Row x, y, z;        ///< means, mm
  Row sx, sy;         ///< spread in the tangent plane, mm
  Row variance;       ///< of z, mm^2
  Row weight;         ///< of the robust fit, 0 = not used
  std::array<std::uint16_t, kMostSegments> line;
  std::array<std::uint16_t, kMostSegments> points;
  std::array<std::uint16_t, kMostSegments> wild;
  std::array<PatchLine, kMostLines> lines;
};

/// Segments whose mean lies within `radius` of the frame's origin in the tangent plane and within `height`
/// above or below it, seen from outside (their line's view against the frame's z).
void gather(const LiveIndex& index, const PatchFrame& frame, double radius, double height, Patch& patch);

/// Keeps what lies within a smaller radius.
void shrink(Patch& patch, double radius);

}  // namespace linescope
