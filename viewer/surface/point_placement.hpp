// Points to fixed point, sixteen at a time: the innermost loop that every mesher begins with.
//
// Points are kept in blocks of sixteen, coordinate by coordinate, which is how the processor takes them.
// From here on everything is integers: no order of points, no rounding and no choice of processor can make a
// difference.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "common/surface_point.hpp"
#include "viewer/surface/block_table.hpp"

namespace linescope {

/// An interval has so many fixed-point steps.
inline constexpr int kStepBits = 11;
inline constexpr int kSteps = 1 << kStepBits;

/// Weight of a point with the typical standard deviation; others get 1 to kMaxPointWeight.
inline constexpr int kTypicalWeight = 4;
inline constexpr int kMaxPointWeight = 16;

/// Sixteen points in order: steps from the line's corner, 0 .. 2^31; weight 0: refused, or no point at all.
inline constexpr std::size_t kPlacedPoints = 16;
struct alignas(32) PlacedBlock {
  std::array<std::int32_t, kPlacedPoints> x{}, y{}, z{}, weight{};
  friend bool operator==(const PlacedBlock&, const PlacedBlock&) = default;
};

constexpr std::size_t blocks_for(std::size_t points) {
  return (points + kPlacedPoints - 1) / kPlacedPoints;
}

/// What a line's points are tested against and measured from; a function of the options and the line's
/// `seen_from`.
struct LinePlacement {
  std::array<float, 4> low{},
      high{};  ///< bounds of x, y, z (mm) and of the standard deviation; NaN fails them all
  std::array<float, 3> origin{};  ///< mm
  float steps_per_mm = 0;
  float weight_scale = 0;  ///< weight of a point = weight_scale / sd^2, rounded
  GridIndex corner;        ///< the grid index of `origin`

  /// Whether a point may enter.
  bool admits(const SurfacePoint& point) const;
};

/// Lowest and highest steps of the usable points, and how many of them there are.
struct PlacedBounds {
  std::array<std::int32_t, 3> low{}, high{};  ///< x y z; of no use when there is no usable point
  std::size_t usable = 0;
  friend bool operator==(const PlacedBounds&, const PlacedBounds&) = default;
};

/// The plain form, and the one that is used where the processor can (AVX2): the same results, bit for bit.
/// `placed` has room for blocks_for(points).
PlacedBounds place_points_portable(const LinePlacement& placement, std::span<const SurfacePoint> points,
                                   PlacedBlock* placed);
PlacedBounds place_points(const LinePlacement& placement, std::span<const SurfacePoint> points,
                          PlacedBlock* placed);

/// The same bounds for points placed before.
PlacedBounds bounds_of(std::span<const PlacedBlock> blocks);

}  // namespace linescope
