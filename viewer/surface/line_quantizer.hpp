// The first step of every mesher: which points of a line may enter, and where they lie in the grid, in fixed
// point.
//
// A point is placed to 1/2048 of the interval (0.6 um at t = 1.27 mm).
#pragma once

#include <span>
#include <vector>

#include "viewer/surface/mesher.hpp"
#include "viewer/surface/point_placement.hpp"

namespace linescope {

/// A line in the grid. Refused points are still there, with weight 0.
struct PlacedLine {
  std::span<const PlacedBlock> points;
  PlacedBounds bounds;
  GridIndex corner;  ///< grid index that the steps are counted from

  std::size_t usable() const { return bounds.usable; }
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
  std::vector<PlacedBlock> placed_;
};

}  // namespace linescope
