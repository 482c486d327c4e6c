// One laser line as the meshers take it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>

#include "common/surface_point.hpp"
#include "common/time.hpp"

namespace linescope {

/// Points of one picture, all seen from one place. Everything is in the frame the surface is held in (the
/// viewer: the object's frame, sensor 2), millimetres. The span is read during the call only.
///
/// `standard_deviation` of a point weighs it (1/sd^2, within a factor of four either way of
/// `MesherOptions::typical_deviation`); 0 means unknown and counts as typical.
struct SurfaceLine {
  std::span<const SurfacePoint> points;
  Eigen::Vector3d seen_from{0, 0, 0};  ///< the camera's centre; says which side of the surface is the outside
  Nanoseconds time = 0;                ///< middle of the exposure
  std::uint64_t id = 0;                ///< running number of the line in the scan, for messages only
};

}  // namespace linescope
