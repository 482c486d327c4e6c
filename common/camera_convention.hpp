// The one place where the two camera frames meet.
//
// The thesis (Eqs 4.1-4.3) writes v_o - v: x right, y UP, z forward. That frame is left-handed. OpenCV's is x
// right, y DOWN, z forward, right-handed. Points and the laser surface live in the thesis's frame; everything
// rigid (hand-eye, boards, tracker) lives in right-handed frames, because no rotation leads from a
// left-handed frame to a right-handed one.
#pragma once

#include <Eigen/Core>

namespace linescope {

/// Camera point or direction, thesis (y up) -> OpenCV (y down). It is its own inverse.
inline Eigen::Vector3d opencv_from_thesis(const Eigen::Vector3d& v) {
  return {v.x(), -v.y(), v.z()};
}
inline Eigen::Vector3d thesis_from_opencv(const Eigen::Vector3d& v) {
  return {v.x(), -v.y(), v.z()};
}

}  // namespace linescope
