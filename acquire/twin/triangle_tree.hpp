// Bounding volume hierarchy over triangles: nearest hit of a ray, nearest point to a point.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "acquire/twin/phantom_kind.hpp"

namespace linescope::twin {

class TriangleTree {
 public:
  /// At least one triangle; indices in range.
  explicit TriangleTree(TriangleSoup mesh);

  struct RayHit {
    double distance;
    int triangle;
  };
  /// Nearest hit with distance > 0, of either side of a triangle.
  std::optional<RayHit> cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const;

  struct Foot {
    Eigen::Vector3d point;
    double squared_distance;
    int triangle;
    Eigen::Vector3d weights;  ///< barycentric, of the triangle's three corners
  };
  Foot nearest(const Eigen::Vector3d& point) const;

  const TriangleSoup& mesh() const { return mesh_; }
  Eigen::Vector3d corner(int triangle, int which) const;
  Eigen::Vector3d face_normal(int triangle) const;  ///< unit

 private:
  // Children of an inner node lie at `first` and `first + 1`; a leaf holds `count` triangles from `first` of
  // order_.
  struct Node {
    Eigen::AlignedBox3d box;
    int first = 0;
    int count = 0;
  };
  // Corner and two edges, in the order of the leaves: what the ray test reads.
  struct Face {
    Eigen::Vector3d origin, edge1, edge2;
  };

  void split(int node, int first, int count, const std::vector<Eigen::Vector3d>& centres);
  void search_leaf(const Node& node, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                   RayHit& best) const;
  void search_nearest(int node, const Eigen::Vector3d& point, Foot& best) const;

  TriangleSoup mesh_;
  std::vector<Node> nodes_;
  std::vector<int> order_;
  std::vector<Face> faces_;
};

}  // namespace linescope::twin
