// A closed triangle mesh as a phantom: a bounding volume hierarchy finds what a ray meets.
#pragma once

#include "acquire/twin/phantom.hpp"
#include "acquire/twin/triangle_tree.hpp"

namespace linescope::twin {

/// Fails with one sentence when the mesh is empty, has an index or a number that cannot be, is not closed
/// (says how many edges are open), or is not in millimetres (its bounding box says so). A mesh that is inside
/// out is turned. The mesh is moved, not turned: its highest point along +z becomes the origin.
Result<std::shared_ptr<const Phantom>> make_triangle_phantom(const TriangleSoup& mesh);

/// The checks of make_triangle_phantom alone.
Result<void> validate(const TriangleSoup& mesh);

class TrianglePhantom : public Phantom {
 public:
  explicit TrianglePhantom(TriangleSoup mesh);

  bool cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, Hit& hit) const override;
  double distance(const Eigen::Vector3d& point) const override;
  Eigen::Vector3d normal(const Eigen::Vector3d& point) const override;
  bool convex() const override { return false; }
  std::string json() const override;

 private:
  TriangleTree tree_;
};

}  // namespace linescope::twin
