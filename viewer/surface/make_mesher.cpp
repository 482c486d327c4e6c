#include "viewer/surface/cubes_mesher.hpp"
#include "viewer/surface/implicit_mesher.hpp"
#include "viewer/surface/mesher.hpp"

namespace linescope {

Result<std::unique_ptr<Mesher>> make_mesher(const MesherOptions& options) {
  if (const auto valid = validate(options); !valid) return tl::unexpected(valid.error());
  if (options.method == MeshMethod::implicit) return std::make_unique<ImplicitMesher>(options);
  return std::make_unique<CubesMesher>(options);
}

}  // namespace linescope
