#include "viewer/surface/cubes_mesher.hpp"
#include "viewer/surface/mesher.hpp"

namespace linescope {

Result<std::unique_ptr<Mesher>> make_mesher(const MesherOptions& options) {
  if (const auto valid = validate(options); !valid) return tl::unexpected(valid.error());
  return std::make_unique<CubesMesher>(options);
}

}  // namespace linescope
