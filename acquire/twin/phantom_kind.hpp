// What the twin looks at, by name.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "common/result.hpp"

namespace linescope::twin {

/// Plain triangles, mm, any frame.
struct TriangleSoup {
  std::vector<Eigen::Vector3d> points;
  std::vector<std::array<int, 3>> triangles;  ///< counter-clockwise seen from outside
};

enum class PhantomKind { condyle, plane, cylinder, mini_knee, mesh, board };

/// A chessboard, counted in squares.
struct BoardPattern {
  int columns = 10;        ///< squares along the long side; 4 .. 100
  int rows = 7;            ///< 4 .. 100
  double square_mm = 1.0;  ///< small enough to be seen whole at 10 mm
};

struct PhantomOptions {
  PhantomKind kind = PhantomKind::condyle;
  double cylinder_diameter_mm = 50.0;  ///< only for `cylinder`; the thesis has 49, 49.1 and 50
  Eigen::Vector3d condyle_semi_axes_mm{
      25, 22, 25};               ///< only for `condyle`: along the donor site, across it, in depth
  double site_length_mm = 25.0;  ///< donor site: the way of the sweep
  double site_width_mm = 10.0;   ///< across the sweep
  BoardPattern board;            ///< only for `board`
  TriangleSoup mesh;             ///< only for `mesh`: its highest point along +z becomes the site
};

/// "condyle", "plane", "cylinder-49", "cylinder-49.1", "cylinder-50" (any diameter), "sphere-50" (any
/// diameter), "mini-knee", "board" or "board-10x7-1" (squares and their side in mm), or the path of a mesh
/// file (ends in .off, triangle_file.hpp). A name that is none of these fails with the list of those that
/// are.
Result<PhantomOptions> phantom_from_name(std::string_view name);

/// The name phantom_from_name understands; "mesh" for a mesh.
std::string name(const PhantomOptions& options);

Result<void> validate(const PhantomOptions& options);

}  // namespace linescope::twin
