#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "common/units.hpp"
#include "tools/prism/prism_design.hpp"

namespace linescope {
namespace {

using Eigen::Vector2d;

// Pixels; y points down, towards the optical axis of the camera, as the beam is bent.
constexpr double kWidth = 640, kHeight = 420;
const Vector2d kExit{300, 200};     // where the beam leaves the prism
constexpr double kFloor = 310;      // lower side of the prism
constexpr double kMostAbove = 150;  // of the apex above the beam

struct Outline {
  Vector2d apex, face1_end, face2_end;
  double face1_x;
};

Outline outline(double delta) {
  const double depth = std::min(120.0, kMostAbove * std::tan(delta));
  const Vector2d along_face2{std::sin(delta), std::cos(delta)};
  Outline o;
  o.face1_x = kExit.x() - depth;
  o.apex = kExit - along_face2 * (depth / std::sin(delta));
  o.face1_end = {o.face1_x, kFloor};
  o.face2_end = kExit + along_face2 * ((kFloor - kExit.y()) / std::cos(delta));
  return o;
}

std::string line(const Vector2d& a, const Vector2d& b, std::string_view style) {
  return fmt::format(R"(<line x1="{:.2f}" y1="{:.2f}" x2="{:.2f}" y2="{:.2f}" {}/>)"
                     "\n",
                     a.x(), a.y(), b.x(), b.y(), style);
}

std::string text(const Vector2d& at, std::string_view words) {
  return fmt::format(R"(<text x="{:.2f}" y="{:.2f}">{}</text>)"
                     "\n",
                     at.x(), at.y(), words);
}

std::string angle(std::string_view name, double radians) {
  return fmt::format("{} = {:.2f}&#176;", name, degrees_from_radians(radians));
}

std::string labels(const PrismDesign& d, const Outline& o) {
  std::string svg;
  svg += text({20, kExit.y() - 12}, fmt::format("air, n = {:g}", d.indices.air));
  svg += text({o.face1_x + 8, kFloor - 10}, fmt::format("prism, n = {:g}", d.indices.prism));
  svg += text({470, 60}, fmt::format("medium, n = {:g}", d.indices.medium));
  svg += text(o.apex + Vector2d(8, -8), angle("&#948;", d.apex_rad));
  svg += text({430, kExit.y() - 8}, "axis F");
  svg += text({430, kExit.y() + 20}, angle("&#947;", d.angles.gamma));
  svg += text({20, 350}, angle("&#952;&#8321;", d.angles.theta1) + ", " +
                             angle("&#952;&#8321;'", d.angles.theta1_prime));
  svg +=
      text({20, 375}, d.critical_rad ? angle("critical angle &#964;", *d.critical_rad) : "no critical angle");
  return svg;
}

}  // namespace

std::string as_svg(const PrismDesign& d) {
  const Outline o = outline(d.apex_rad);
  const Vector2d normal{std::cos(d.apex_rad), -std::sin(d.apex_rad)};
  const Vector2d leaving{std::cos(d.angles.gamma), std::sin(d.angles.gamma)};
  constexpr std::string_view kBeam = R"(stroke="#0a9d2a" stroke-width="3")";
  constexpr std::string_view kHelp = R"(stroke="#777" stroke-dasharray="6 4")";
  std::string svg =
      fmt::format(R"(<svg xmlns="http://www.w3.org/2000/svg" width="{0}" height="{1}" viewBox="0 0 {0} {1}">)"
                  "\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n<g font-family=\"sans-serif\" "
                  "font-size=\"14\">\n",
                  kWidth, kHeight);
  svg += fmt::format(
      R"(<polygon points="{:.2f},{:.2f} {:.2f},{:.2f} {:.2f},{:.2f}" fill="#d8e8f8" stroke="#246"/>)"
      "\n",
      o.apex.x(), o.apex.y(), o.face1_end.x(), o.face1_end.y(), o.face2_end.x(), o.face2_end.y());
  svg += line(kExit - 110 * normal, kExit + 110 * normal, kHelp);
  svg += line(kExit, {kWidth - 20, kExit.y()}, kHelp);
  svg += line({20, kExit.y()}, kExit, kBeam);
  svg += line(kExit, kExit + 300 * leaving, kBeam);
  return svg + labels(d, o) + "</g>\n</svg>\n";
}

}  // namespace linescope
