// Which points of a line may enter the grid; the others are counted by reason. The same for every mesher.
#pragma once

#include <cmath>

#include "viewer/surface/block_table.hpp"
#include "viewer/surface/mesher.hpp"

namespace linescope {

/// The box of one line in which its points are believed.
class PointGate {
 public:
  /// `line.seen_from` must be finite (see admits_line).
  PointGate(const MesherOptions& options, const SurfaceLine& line)
      : max_deviation_(static_cast<float>(options.max_deviation)),
        seen_from_(line.seen_from.cast<float>()),
        distance_(static_cast<float>(options.max_distance)),
        limit_(static_cast<float>((kGridLimit - 1) * options.interval)) {
    low_ = (seen_from_.array() - distance_).max(-limit_);
    high_ = (seen_from_.array() + distance_).min(limit_);
  }

  static bool admits_line(const SurfaceLine& line) { return line.seen_from.allFinite(); }

  /// NaN fails every comparison, so this one test is all a good point has to pass.
  bool admits(const SurfacePoint& point) const {
    const Eigen::Vector3f& p = point.position;
    return p.x() >= low_.x() && p.x() <= high_.x() && p.y() >= low_.y() && p.y() <= high_.y() &&
           p.z() >= low_.z() && p.z() <= high_.z() && point.standard_deviation >= 0 &&
           point.standard_deviation <= max_deviation_;
  }

  /// Why a point was not admitted.
  void count_refusal(const SurfacePoint& point, MesherCounters& counters) const {
    if (!point.position.allFinite() || !std::isfinite(point.standard_deviation))
      ++counters.not_finite;
    else if (((point.position - seen_from_).array().abs() > distance_).any())
      ++counters.too_far;
    else if ((point.position.array().abs() > limit_).any())
      ++counters.no_room;
    else
      ++counters.too_uncertain;
  }

 private:
  float max_deviation_;
  Eigen::Vector3f seen_from_;
  float distance_;
  float limit_;
  Eigen::Array3f low_, high_;
};

}  // namespace linescope
