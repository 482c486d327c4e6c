// Eight triangles side by side, and the one of them that is nearest to a place: what a search through a mesh
// spends its time on. A triangle costs the same whichever of its parts is nearest; there is no branch in it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

namespace linescope {

/// Corners a, a + ab, a + ac. Lanes that hold no triangle are infinitely far away.
struct alignas(32) TriangleBatch {
  static constexpr int kLanes = 8;
  static constexpr std::int32_t kNone = -1;  ///< no triangle
  static constexpr int kNoLane = -1;
  using Row = std::array<float, kLanes>;
  using Vectors = std::array<Row, 3>;  ///< x, y, z

  Vectors a, ab, ac;
  Row per_bb, per_cc, per_ee;                 ///< 1 / squared lengths of ab, ac and ac - ab; 0 for a point
  Row per_area;                               ///< 1 / squared length of ab x ac; 0 for a line
  std::array<std::int32_t, kLanes> triangle;  ///< whose lane it is

  TriangleBatch();
  void put(int lane, const Eigen::Vector3f& a_corner, const Eigen::Vector3f& ab_side,
           const Eigen::Vector3f& ac_side, std::int32_t number);
  void empty(int lane);
  /// The lane that holds this triangle or, with kNone, one that is free; kNoLane when there is none.
  int lane_of(std::int32_t number) const;
};

/// The lane nearest to a place, if it is nearer than `best` (squared distance, mm^2, which it then becomes);
/// otherwise kNoLane. Uses AVX2 and FMA where the processor has them; agrees with the portable way to
/// rounding.
int nearer_lane(const TriangleBatch& batch, const Eigen::Vector3f& place, float& best);
int nearer_lane_portable(const TriangleBatch& batch, const Eigen::Vector3f& place, float& best);

}  // namespace linescope
