#include "viewer/measure/shape_evaluation.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace linescope {
namespace {

constexpr std::size_t kFewest = 10;
constexpr double kLargestDiameter = 2'000;  ///< mm: what is flatter than this is called a plane

struct Fit {
  Eigen::Vector3d centre{0, 0, 0}, direction{0, 0, 1};
  double radius = 0;
};

std::optional<Fit> plane_fit(const Points3& points) {
  const auto wall = fitted_wall(points);
  if (!wall) return std::nullopt;
  return Fit{wall->centre, wall->normal, 0};
}

std::optional<Fit> cylinder_fit(const Points3& points) {
  const auto cylinder = fitted_cylinder(points);
  if (!cylinder) return std::nullopt;
  const Eigen::Vector3d& axis = cylinder->axis;
  const Eigen::Vector3d u = axis.unitOrthogonal(), v = axis.cross(u);
  const Eigen::Vector2d& c = cylinder->section.centre;
  return Fit{c.x() * u + c.y() * v, axis, cylinder->section.radius};
}

std::optional<Fit> sphere_fit(const Points3& points) {
  const auto ball = fitted_ball(points);
  if (!ball) return std::nullopt;
  return Fit{ball->centre, {0, 0, 1}, ball->radius};
}

std::optional<Fit> fit(const Points3& points, Shape shape) {
  switch (shape) {
    case Shape::plane:
      return plane_fit(points);
    case Shape::cylinder:
      return cylinder_fit(points);
    case Shape::sphere:
      return sphere_fit(points);
  }
  return std::nullopt;
}

double distance(const Eigen::Vector3d& p, const Fit& f, Shape shape) {
  const Eigen::Vector3d from = p - f.centre;
  if (shape == Shape::plane) return from.dot(f.direction);
  if (shape == Shape::sphere) return from.norm() - f.radius;
  return (from - from.dot(f.direction) * f.direction).norm() - f.radius;
}

void describe(const Points3& points, const Fit& f, ShapeEvaluation& e) {
  double sum = 0, squares = 0, sizes = 0;
  for (const Eigen::Vector3d& p : points) {
    const double d = distance(p, f, e.shape);
    sum += d;
    squares += d * d;
    sizes += std::abs(d);
    e.maximum = std::max(e.maximum, std::abs(d));
  }
  const auto n = static_cast<double>(points.size());
  e.points = points.size();
  e.mean = sum / n;
  e.mean_size = sizes / n;
  e.deviation = std::sqrt(std::max(0.0, squares - n * e.mean * e.mean) / (n - 1));
}

}  // namespace

const char* name(Shape shape) {
  switch (shape) {
    case Shape::plane:
      return "plane";
    case Shape::cylinder:
      return "cylinder";
    case Shape::sphere:
      return "sphere";
  }
  return "?";
}

Points3 points_in(std::span<const Eigen::Vector3f> points, const Region& region) {
  Points3 inside;
  for (const Eigen::Vector3f& p : points) {
    const Eigen::Vector3d q = p.cast<double>();
    if (q.allFinite() && (region.all || (q - region.centre).norm() <= region.radius)) inside.push_back(q);
  }
  return inside;
}

Result<ShapeEvaluation> evaluate_shape(std::span<const Eigen::Vector3f> points, Shape shape,
                                       const Region& region, double nominal_diameter) {
  if (!(nominal_diameter >= 0 && nominal_diameter <= kLargestDiameter))
    return fail(ErrorCode::usage,
                fmt::format("a nominal diameter of {} mm is none; 0 means not known", nominal_diameter));
  const Points3 inside = points_in(points, region);
  if (inside.size() < kFewest)
    return fail(ErrorCode::too_few,
                fmt::format("{} points are too few for a {}; scan there, or take a larger region",
                            inside.size(), name(shape)));
  const auto found = fit(inside, shape);
  if (!found || !(2 * found->radius <= kLargestDiameter))
    return fail(
        ErrorCode::too_little_variation,
        fmt::format("these points do not determine a {}: they are too flat; take a larger region or a plane",
                    name(shape)));
  ShapeEvaluation e;
  e.shape = shape;
  e.region = region;
  e.diameter = 2 * found->radius;
  e.nominal = nominal_diameter;
  e.centre = found->centre;
  e.direction = found->direction;
  describe(inside, *found, e);
  return e;
}

std::string sentence(const ShapeEvaluation& e) {
  std::string text = name(e.shape);
  if (e.has_diameter()) text += fmt::format(": diameter {:.2f} mm", e.diameter);
  if (e.has_difference())
    text += fmt::format(" (nominal {:.2f}, {:+.2f} mm, {:+.1f} %)", e.nominal, e.difference(),
                        e.difference_percent());
  return text + fmt::format("; distances mean {:.3f}, SD {:.3f}, maximum {:.3f} mm; {} points", e.mean,
                            e.deviation, e.maximum, e.points);
}

}  // namespace linescope
