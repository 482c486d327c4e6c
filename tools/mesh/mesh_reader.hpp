// Mesh files by VTK's readers, as plain arrays: the one place of this tool that knows VTK.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace linescope {

struct MeshArrays {
  std::vector<std::array<double, 3>> points;
  std::vector<std::array<int, 3>> triangles;
  std::string fault;  ///< one sentence when the file could not be read; empty otherwise
};

/// STL, PLY, OBJ or VTP, chosen by the file's suffix (any case). Polygons and strips are split into
/// triangles, points at the same place are made one (STL repeats every corner), degenerate triangles are left
/// out.
MeshArrays read_mesh(const std::filesystem::path& file);

}  // namespace linescope
