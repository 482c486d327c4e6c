// Triangle meshes in files that every other program reads. Written and read by VTK.
//
// What the formats hold of a TriangleMesh, always in millimetres:
//   .ply  positions, normals, triangles; "linescope", frame and unit as comments (binary, little endian)
//   .vtp  everything: also uncertainty, observations, origin of the triangles; frame and unit as field data
//         and in a comment
//   .stl  triangles only (every corner three times); frame and unit in the 80 bytes of its header (binary)
//   .obj  positions, normals, triangles; frame and unit in the first line's comment (text)
// PLY and VTP open in 3D Slicer, ParaView and MeshLab as they are. A file is complete or not there: it is
// written beside its place and then moved.
#pragma once

#include <filesystem>
#include <string>

#include "common/result.hpp"
#include "viewer/surface/triangle_mesh.hpp"

namespace linescope {

/// Suffix decides the format. `frame`: what the coordinates are relative to, for example "Object" (sensor 2).
Result<void> write_mesh(const TriangleMesh& mesh, const std::filesystem::path& file,
                        const std::string& frame);

enum class Corners {
  as_stored,  ///< points at the same place are made one only when the format repeats every corner (STL)
  merged,     ///< in every format: for bodies, whose triangles must meet
};

/// Polygons and strips are split into triangles, missing normals are computed. Triangles without area are
/// left out. Refused with a sentence: no such file, another suffix, not readable, no triangle in it,
/// coordinates that are not finite.
Result<TriangleMesh> read_mesh(const std::filesystem::path& file, Corners corners = Corners::as_stored);

}  // namespace linescope
