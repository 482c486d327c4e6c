#include "acquire/twin/phantom_kind.hpp"

#include <fmt/format.h>

#include <charconv>
#include <utility>

#include "acquire/twin/triangle_file.hpp"
#include "acquire/twin/triangle_phantom.hpp"

namespace linescope::twin {
namespace {

constexpr std::string_view kCylinderPrefix = "cylinder-";

Result<PhantomOptions> unknown(std::string_view name) {
  return fail(
      ErrorCode::usage,
      fmt::format(
          "no phantom is called '{}': use condyle, plane, cylinder-49, cylinder-49.1, cylinder-50 (any "
          "diameter in mm), mini-knee, or a mesh file FILE.off (linescope-mesh makes one)",
          name));
}

Result<PhantomOptions> cylinder(std::string_view name) {
  PhantomOptions options;
  options.kind = PhantomKind::cylinder;
  const std::string_view number = name.substr(kCylinderPrefix.size());
  const char* end = number.data() + number.size();
  const auto [stop, error] = std::from_chars(number.data(), end, options.cylinder_diameter_mm);
  if (error != std::errc{} || stop != end) return unknown(name);
  if (auto valid = validate(options); !valid) return tl::unexpected(valid.error());
  return options;
}

Result<PhantomOptions> mesh_from_file(std::string_view file) {
  auto mesh = read_triangles(file);
  if (!mesh) return tl::unexpected(mesh.error());
  if (auto valid = validate(*mesh); !valid)
    return fail(valid.error().code, fmt::format("{}: {}", file, valid.error().message));
  PhantomOptions options;
  options.kind = PhantomKind::mesh;
  options.mesh = std::move(*mesh);
  return options;
}

}  // namespace

Result<PhantomOptions> phantom_from_name(std::string_view name) {
  PhantomOptions options;
  if (name == "condyle") return options;
  if (name.starts_with(kCylinderPrefix)) return cylinder(name);
  if (name.ends_with(kTriangleFileSuffix)) return mesh_from_file(name);
  if (name == "plane") {
    options.kind = PhantomKind::plane;
    return options;
  }
  if (name == "mini-knee") {
    options.kind = PhantomKind::mini_knee;
    options.site_length_mm = 6.0;
    options.site_width_mm = 9.0;
    return options;
  }
  return unknown(name);
}

std::string name(const PhantomOptions& options) {
  switch (options.kind) {
    case PhantomKind::condyle:
      return "condyle";
    case PhantomKind::plane:
      return "plane";
    case PhantomKind::cylinder:
      return fmt::format("cylinder-{:g}", options.cylinder_diameter_mm);
    case PhantomKind::mini_knee:
      return "mini-knee";
    case PhantomKind::mesh:
      return "mesh";
  }
  return "unknown";
}

Result<void> validate(const PhantomOptions& options) {
  const bool round = options.cylinder_diameter_mm >= 5 && options.cylinder_diameter_mm <= 1000;
  if (options.kind == PhantomKind::cylinder && !round) {
    return fail(ErrorCode::invalid,
                fmt::format("a cylinder of {:g} mm diameter cannot be scanned: use 5 to 1000 mm",
                            options.cylinder_diameter_mm));
  }
  const Eigen::Vector3d& axes = options.condyle_semi_axes_mm;
  if (options.kind == PhantomKind::condyle && !(axes.minCoeff() >= 5 && axes.maxCoeff() <= 500)) {
    return fail(ErrorCode::invalid,
                fmt::format("a condyle with semi-axes {:g}, {:g}, {:g} mm cannot be scanned: use 5 to 500 mm",
                            axes.x(), axes.y(), axes.z()));
  }
  const double length = options.site_length_mm, width = options.site_width_mm;
  if (!(length >= 1 && length <= 100 && width >= 1 && width <= 100)) {
    return fail(
        ErrorCode::invalid,
        fmt::format("a donor site of {:g} x {:g} mm is not possible: use 1 to 100 mm", length, width));
  }
  return {};
}

}  // namespace linescope::twin
