// The first step of every mesher: which points of a line may enter, and where they lie in the grid, in fixed
// point.
//
// A point is placed to 1/2048 of the interval (0.6 um at t = 1.27 mm). From there on everything is integers:
// no order of points, no rounding and no choice of processor can make a difference.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "viewer/surface/block_table.hpp"
#include "viewer/surface/mesher.hpp"

namespace linescope {

/// An interval has so many fixed-point steps.
inline constexpr int kStepBits = 11;
inline constexpr int kSteps = 1 << kStepBits;

/// Weight of a point with the typical standard deviation; others get 1 to kMaxPointWeight.
inline constexpr int kTypicalWeight = 4;
inline constexpr int kMaxPointWeight = 16;

/// Steps from the line's corner, 0 .. 2^31; weight 0: refused.
struct alignas(16) PlacedPoint {
  std::int32_t x = 0, y = 0, z = 0;
  std::int32_t weight = 0;
  friend bool operator==(const PlacedPoint&, const PlacedPoint&) = default;
};

/// What a line's points are tested against and measured from; a function of the options and the line's
/// `seen_from`.
struct LinePlacement {
  std::array<float, 4> low{},
      high{};  ///< bounds of x, y, z (mm) and of the standard deviation; NaN fails them all
  std::array<float, 4> origin{};  ///< mm; the fourth is 0
  float steps_per_mm = 0;
  float weight_scale = 0;  ///< weight of a point = weight_scale / sd^2, rounded
  GridIndex corner;        ///< the grid index of `origin`
};

/// Lowest and highest steps of the usable points, and how many were refused.
struct PlacedBounds {
  std::array<std::int32_t, 4> low{}, high{};  ///< x y z; the fourth is of no use
  std::size_t refused = 0;
};

/// The plain form, and the one that is used where the processor can (AVX2): the same results, bit for bit.
PlacedBounds place_points_portable(const LinePlacement& placement, std::span<const SurfacePoint> points,
                                   PlacedPoint* placed);
PlacedBounds place_points(const LinePlacement& placement, std::span<const SurfacePoint> points,
                          PlacedPoint* placed);

/// The same bounds for points placed before.
PlacedBounds bounds_of(std::span<const PlacedPoint> points);

/// A line in the grid. Refused points are still there, with weight 0.
struct PlacedLine {
  std::span<const PlacedPoint> points;
  PlacedBounds bounds;
  GridIndex corner;  ///< grid index that the steps are counted from

  std::size_t usable() const { return points.size() - bounds.refused; }
};

class LineQuantizer {
 public:
  explicit LineQuantizer(const MesherOptions& options);

  /// The line's points, in order; counts the refused ones by reason. No points when `seen_from` is not a
  /// place. The result is valid until the next call.
  PlacedLine place(const SurfaceLine& line, MesherCounters& counters);

 private:
  void prepare(const SurfaceLine& line);
  void count_refused(const SurfaceLine& line, MesherCounters& counters) const;

  double interval_;
  double max_distance_;  // mm, as asked for
  double reach_;         // mm, the same or as far as steps can be counted
  float max_deviation_;
  LinePlacement placement_;
  std::vector<PlacedPoint> placed_;
};

}  // namespace linescope
