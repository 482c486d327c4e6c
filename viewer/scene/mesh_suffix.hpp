// A file's suffix in lower case: ".ply". Shared by reading and writing of meshes.
#pragma once

#include <filesystem>
#include <string>

namespace linescope {

std::string mesh_suffix(const std::filesystem::path& file);

}  // namespace linescope
