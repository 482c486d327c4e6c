// The point of a triangle mesh nearest to a place (target T14), kept current triangle by triangle while the
// mesh changes.
//
// Triangles are entered, eight side by side, in every cell of a sparse grid that their box touches. A search
// looks into the cells next to the place, the nearest cell first, then ring by ring, and leaves out those
// that are farther than the best so far, until no nearer triangle can lie farther out. Exact: never farther
// than the brute-force answer. One thread may change it while nobody searches; any number may search.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "viewer/navigate/cell_grid.hpp"
#include "viewer/navigate/triangle_batch.hpp"
#include "viewer/surface/triangle_mesh.hpp"

namespace linescope {

class TriangleLocator {
 public:
  struct Triangle {
    Eigen::Vector3f a, b, c;
  };
  struct Nearest {
    std::uint64_t owner = 0;  ///< as given to replace(); with assign(), the triangle's index in the mesh
    Eigen::Vector3f point;
    float distance = 0;  ///< mm
  };

  /// Cells about as large as the triangles serve best, mm.
  explicit TriangleLocator(double cell_size = 1.27) : grid_(cell_size) {}

  /// All triangles of a mesh, in place of what was there.
  void assign(const TriangleMesh& mesh);

  /// The triangles of one owner (a cube of the mesher, say) in place of its former ones; an empty span
  /// removes them. The cost does not depend on the size of the mesh. Triangles that are not finite are left
  /// out.
  void replace(std::uint64_t owner, std::span<const Triangle> triangles);
  void clear();

  std::size_t size() const { return size_; }

  /// Nothing when no triangle lies within `reach`, mm.
  std::optional<Nearest> nearest(const Eigen::Vector3f& place, float reach = 20.0f) const;

 private:
  struct Stored {
    Eigen::Vector3f a, ab, ac;
    std::uint64_t owner = 0;
  };
  using Cell = std::vector<TriangleBatch>;
  class Gaps;
  struct Best {
    float squared;
    std::int32_t triangle = TriangleBatch::kNone;
  };

  void enter(const Triangle& triangle, std::uint64_t owner, std::vector<std::int32_t>& mine);
  void remove(std::int32_t triangle);
  template <class Visit>
  void visit_cells_of(const Stored& triangle, Visit&& visit);
  void look_into(std::int32_t cell, const Eigen::Vector3f& place, Best& best) const;
  void look_next_door(const Gaps& gaps, const Eigen::Vector3f& place, Best& best) const;
  void look_farther(const Gaps& gaps, int from, int to, const Eigen::Vector3f& place, Best& best) const;

  CellGrid grid_;
  std::vector<Cell> cells_;
  std::vector<Stored> triangles_;
  std::vector<std::int32_t> free_;
  std::unordered_map<std::uint64_t, std::vector<std::int32_t>> owners_;
  std::size_t size_ = 0;
};

}  // namespace linescope
