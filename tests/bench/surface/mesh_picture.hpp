// Shaded drawings of meshes, side by side, without a graphics library's window: for the documentation.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/result.hpp"
#include "viewer/surface/triangle_mesh.hpp"

namespace linescope::bench {

struct PictureTile {
  std::string title;
  TriangleMesh mesh;
};

/// Rows of tiles, all seen from the same side and in the same scale, as a PNG file.
Result<void> write_picture(const std::vector<std::vector<PictureTile>>& rows,
                           const std::filesystem::path& file);

}  // namespace linescope::bench
