#include "acquire/twin/board_phantom.hpp"
#include "acquire/twin/ellipsoid.hpp"
#include "acquire/twin/phantom.hpp"
#include "acquire/twin/simple_shapes.hpp"
#include "acquire/twin/triangle_phantom.hpp"

namespace linescope::twin {
namespace {

using Eigen::Vector3d;

std::shared_ptr<const Phantom> condyle(const Vector3d& axes) {
  return std::make_shared<Ellipsoid>(axes, Vector3d(0, 0, -axes.z()));
}

// 9 x 6 x 2 mm (thesis 4.5.2): two small condyles side by side on a plate, with the groove between them.
std::shared_ptr<const Phantom> mini_knee() {
  const Vector3d axes{3.0, 2.4, 2.0};
  std::vector<std::shared_ptr<const Phantom>> parts = {
      std::make_shared<Ellipsoid>(axes, Vector3d(0, -2.1, -2.0)),
      std::make_shared<Ellipsoid>(axes, Vector3d(0, 2.1, -2.0)), std::make_shared<PlaneBody>(-2.0)};
  return std::make_shared<UnionBody>(std::move(parts));
}

}  // namespace

Result<std::shared_ptr<const Phantom>> make_phantom(const PhantomOptions& options) {
  if (auto valid = validate(options); !valid) return tl::unexpected(valid.error());
  switch (options.kind) {
    case PhantomKind::condyle:
      return condyle(options.condyle_semi_axes_mm);
    case PhantomKind::plane:
      return std::make_shared<PlaneBody>();
    case PhantomKind::cylinder:
      return std::make_shared<CylinderBody>(options.cylinder_diameter_mm);
    case PhantomKind::mini_knee:
      return mini_knee();
    case PhantomKind::board:
      return std::make_shared<BoardPhantom>(options.board);
    case PhantomKind::mesh:
      return make_triangle_phantom(options.mesh);
  }
  return fail(ErrorCode::internal, "unknown kind of phantom");
}

}  // namespace linescope::twin
