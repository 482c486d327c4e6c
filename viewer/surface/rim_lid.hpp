// A lid over a rim of any shape: a triangulation of the polygon, with new corners where its edges are long.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace linescope {

/// The work grows with the third power of the corners.
inline constexpr std::size_t kMaxRimCorners = 128;

struct RimLid {
  std::vector<Eigen::Vector3d> corners;                 ///< the rim's, in order, then new ones
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise seen along -z
};

/// The triangulation with the least area in space (Barequet and Sharir 1995, by dynamic programming) of those
/// whose triangles all run counter-clockwise seen from above: then none folds over another. No corner is
/// added.
/// `rim`: u, v, height, counter-clockwise; no more than kMaxRimCorners. `taken(i, j)`: corners i and j are
/// joined outside the lid, so the lid must not join them again.
/// Nothing when there is no such triangulation: the rim crosses itself seen from above.
std::optional<RimLid> triangulate_rim(const std::vector<Eigen::Vector3d>& rim,
                                      const std::function<bool(std::size_t, std::size_t)>& taken);

/// Halves edges between triangles, the longest first, until none is longer than this seen from above, or
/// there are `most_corners`. The rim's own edges stay.
void split_long_edges(RimLid& lid, double longest, std::size_t most_corners);

}  // namespace linescope
