#include "acquire/twin/phantom_kind.hpp"

#include <fmt/format.h>

#include <charconv>
#include <utility>

#include "acquire/twin/triangle_file.hpp"
#include "acquire/twin/triangle_phantom.hpp"

namespace linescope::twin {
namespace {

constexpr std::string_view kCylinderPrefix = "cylinder-";
constexpr std::string_view kSpherePrefix = "sphere-";
constexpr std::string_view kBoardName = "board";

Result<PhantomOptions> unknown(std::string_view name) {
  return fail(
      ErrorCode::usage,
      fmt::format(
          "no phantom is called '{}': use condyle, plane, cylinder-49, cylinder-49.1, cylinder-50 (any "
          "diameter in mm), sphere-50 (any diameter), mini-knee, board, board-10x7-1 (squares and their "
          "side in mm), or a mesh file FILE.off (linescope-mesh makes one)",
          name));
}

/// Takes the number that the text begins with off it; false when there is none.
template <class Number>
bool take_number(std::string_view& text, Number& number) {
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  text.remove_prefix(static_cast<std::size_t>(stop - text.data()));
  return error == std::errc{};
}

bool take_text(std::string_view& text, std::string_view expected) {
  if (!text.starts_with(expected)) return false;
  text.remove_prefix(expected.size());
  return true;
}

Result<PhantomOptions> if_valid(const PhantomOptions& options) {
  if (auto valid = validate(options); !valid) return tl::unexpected(valid.error());
  return options;
}

Result<PhantomOptions> cylinder(std::string_view name) {
  PhantomOptions options;
  options.kind = PhantomKind::cylinder;
  std::string_view rest = name.substr(kCylinderPrefix.size());
  if (!take_number(rest, options.cylinder_diameter_mm) || !rest.empty()) return unknown(name);
  return if_valid(options);
}

// A condyle whose axes are alike.
Result<PhantomOptions> sphere(std::string_view name) {
  PhantomOptions options;
  double diameter = 0;
  std::string_view rest = name.substr(kSpherePrefix.size());
  if (!take_number(rest, diameter) || !rest.empty()) return unknown(name);
  options.condyle_semi_axes_mm.setConstant(0.5 * diameter);
  return if_valid(options);
}

Result<PhantomOptions> board(std::string_view name) {
  PhantomOptions options;
  options.kind = PhantomKind::board;
  BoardPattern& b = options.board;
  std::string_view rest = name.substr(kBoardName.size());
  const bool understood =
      rest.empty() || (take_text(rest, "-") && take_number(rest, b.columns) && take_text(rest, "x") &&
                       take_number(rest, b.rows) && take_text(rest, "-") && take_number(rest, b.square_mm));
  if (!understood || !rest.empty()) return unknown(name);
  return if_valid(options);
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
  if (name.starts_with(kSpherePrefix)) return sphere(name);
  if (name.ends_with(kTriangleFileSuffix)) return mesh_from_file(name);
  if (name.starts_with(kBoardName)) return board(name);
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
    case PhantomKind::condyle: {
      const Eigen::Vector3d& axes = options.condyle_semi_axes_mm;
      const bool round = axes.minCoeff() == axes.maxCoeff();
      return round ? fmt::format("sphere-{:g}", 2 * axes.x()) : "condyle";
    }
    case PhantomKind::plane:
      return "plane";
    case PhantomKind::cylinder:
      return fmt::format("cylinder-{:g}", options.cylinder_diameter_mm);
    case PhantomKind::mini_knee:
      return "mini-knee";
    case PhantomKind::mesh:
      return "mesh";
    case PhantomKind::board:
      return fmt::format("board-{}x{}-{:g}", options.board.columns, options.board.rows,
                         options.board.square_mm);
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
  const BoardPattern& b = options.board;
  const bool printable = b.columns >= 4 && b.columns <= 100 && b.rows >= 4 && b.rows <= 100 &&
                         b.square_mm >= 0.05 && b.square_mm <= 100;
  if (options.kind == PhantomKind::board && !printable) {
    return fail(
        ErrorCode::invalid,
        fmt::format("a board of {} x {} squares of {:g} mm cannot be used: use 4 to 100 squares of 0.05 "
                    "to 100 mm",
                    b.columns, b.rows, b.square_mm));
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
