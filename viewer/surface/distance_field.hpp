// Signed distances at grid vertices, blended from the patches around them, and the cubes the surface runs
// through.
//
// All sums are integers: taking a patch out subtracts exactly what it added, so any history with the same
// patches ends in the same field.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "viewer/surface/chunked_pool.hpp"
#include "viewer/surface/patch_map.hpp"
#include "viewer/surface/sparse_index.hpp"

namespace linescope {

/// What the patches say about a grid vertex, in fixed point (see distance_field.cpp for the units).
struct VertexSums {
  void add(const VertexSums& other);

  std::int64_t weight = 0;
  std::int64_t distance = 0;
  std::array<std::int64_t, 3> normal{};
  std::array<std::int64_t, 3> centre{};  ///< of the points in the columns around, from the vertex
  std::int64_t deviation = 0;
  std::int64_t points = 0;
};

/// The same as values.
struct alignas(64) FieldVertex {
  GridIndex at;
  float distance = 0;   ///< intervals, positive on the side it was seen from
  float support = 0;    ///< intervals to the border of what was seen, to first order; negative beyond
  float deviation = 0;  ///< intervals
  Eigen::Vector3f normal{0, 0, 0};
  const SparseIndex::Block* block = nullptr;  ///< where `at` lies
  std::uint32_t round = 0;                    ///< the update that last looked at the cube above it
  std::uint8_t corners = 0;                   ///< case of the cube above this vertex (0: no surface there)
  bool known = false;                         ///< patches reach it and agree on the side
  bool changed = false;
  VertexSums sums;
};

class DistanceField final : public PatchListener {
 public:
  void patch_added(const MomentCell& cell, const SurfacePatch& patch) override { apply(cell, patch, 1); }
  void patch_removed(const MomentCell& cell, const SurfacePatch& patch) override { apply(cell, patch, -1); }

  /// Brings the values and cases up to date with the patches.
  void update();

  void clear();

  const FieldVertex& vertex(std::int32_t number) const { return vertices_[number]; }
  std::size_t vertex_count() const { return vertices_.size(); }

  /// The eight corners of the cube above a vertex (bit 0: x, 1: y, 2: z): their numbers or
  /// SparseIndex::kNone.
  std::array<std::int32_t, 8> corners_of(const FieldVertex& low) const;

  /// Calls `visit(number)` for every vertex in an order that depends on the places only.
  template <class Visit>
  void for_each_ordered(Visit visit) {
    index_.for_each_ordered(visit);
  }

  std::size_t memory_bytes() const;

 private:
  void apply(const MomentCell& cell, const SurfacePatch& patch, int sign);
  void add_column(GridIndex lowest, int axis, int count, VertexSums sums, const VertexSums& one_up);
  std::int32_t vertex_at(SparseIndex::Block& block, int local);
  void add(std::int32_t vertex, const VertexSums& sums);
  void find_cases_near(const FieldVertex& vertex);
  void evaluate(FieldVertex& vertex);
  void find_case(FieldVertex& vertex);

  SparseIndex index_;
  ChunkedPool<FieldVertex> vertices_;
  std::vector<std::int32_t> changed_;
  std::uint32_t round_ = 0;
};

}  // namespace linescope
