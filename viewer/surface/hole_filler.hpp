// Closes holes in an open surface, visibly: what is added is marked as filled, nobody measured it.
#pragma once

#include <cstddef>
#include <string>

#include "viewer/surface/triangle_mesh.hpp"

namespace linescope {

struct HoleCounts {
  std::size_t filled = 0;
  std::size_t left = 0;      ///< all the others:
  std::size_t too_long = 0;  ///< rim longer than allowed
  std::size_t too_many = 0;  ///< neither star-shaped nor of at most kMaxRimCorners vertices
  std::size_t crossing = 0;  ///< the rim crosses itself, seen along the mean normal
};

/// For people: how many were closed, how many stay open, and why.
std::string in_words(const HoleCounts& holes);

/// Fills every hole whose rim is at most `longest_rim` mm long. Of the borders of a connected piece the
/// longest is the outer one and never a hole.
///
/// The added vertices lie on rings between the rim and its middle (where parts of the rim hide behind others,
/// seen from its middle: on the edges of a triangulation, rim_lid.hpp), on the quadric through the rim's
/// vertices and normals (so that curvature goes on), bent to meet the rim. They have 0 observations and an
/// uncertainty of NaN; the added triangles have TriangleOrigin::filled. What was there stays as it is, in
/// front.
HoleCounts fill_holes(TriangleMesh& mesh, double longest_rim);

}  // namespace linescope
