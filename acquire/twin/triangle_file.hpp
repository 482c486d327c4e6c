// Plain triangles from a file: the Object File Format (OFF), text.
//
//   OFF
//   <points> <triangles> <edges, not looked at>
//   x y z              (mm, one line per point)
//   3 i j k            (indices from 0, counter-clockwise seen from outside)
//
// linescope-mesh makes such a file of STL, PLY, OBJ and VTP.
#pragma once

#include <filesystem>
#include <string>

#include "acquire/twin/phantom_kind.hpp"

namespace linescope::twin {

/// Names of files, not of built-in phantoms, end in this.
inline constexpr std::string_view kTriangleFileSuffix = ".off";

/// Failures name the file and the line. Whether the triangles make a body is not asked here
/// (triangle_phantom.hpp).
Result<TriangleSoup> read_triangles(const std::filesystem::path& file);

/// The text of such a file; every number comes back with the same bits.
std::string triangles_text(const TriangleSoup& mesh);

}  // namespace linescope::twin
