#include "viewer/navigate/algorithm_1.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace linescope {
namespace {

struct Chosen {
  Eigen::Vector3d point;
  double cost;
};

struct Search {
  std::span<const Eigen::Vector3f> points;
  Eigen::Vector3d tip;
  double radius;
  double outer;

  double side() const { return std::sqrt(3.0) * radius; }
  bool side_allowed(double length) const {
    return length > std::sqrt(3.0) && length < std::sqrt(3.0) * outer;
  }

  /// The best point whose sides to the vertices found so far are allowed.
  std::optional<Chosen> next(std::span<const Eigen::Vector3d> found) const {
    std::optional<Chosen> best;
    double best_cost = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector3f& candidate : points) {
      const Eigen::Vector3d p = candidate.cast<double>();
      const double cost_here = cost(p, found, best_cost);
      if (cost_here < best_cost) {
        best_cost = cost_here;
        best = Chosen{p, cost_here};
      }
    }
    return best;
  }

 private:
  double cost(const Eigen::Vector3d& p, std::span<const Eigen::Vector3d> found, double give_up_at) const {
    constexpr double kNever = std::numeric_limits<double>::infinity();
    const double from_tip = (p - tip).norm();
    if (!(from_tip > 1.0 && from_tip < outer)) return kNever;
    double sum = std::abs(from_tip - radius);
    for (const Eigen::Vector3d& vertex : found) {
      if (sum >= give_up_at) return kNever;
      const double length = (p - vertex).norm();
      if (!side_allowed(length)) return kNever;
      sum += std::abs(length - side());
    }
    return sum;
  }
};

InscribedTriangle fallback(const Eigen::Vector3d& view) {
  InscribedTriangle result;
  result.normal = -view.normalized();
  return result;
}

}  // namespace

Result<void> validate(const Algorithm1Options& options) {
  if (!(std::isfinite(options.line_width) && options.line_width > 2))
    return fail(
        ErrorCode::invalid,
        fmt::format(
            "Algorithm 1: line width {} mm leaves no radius between 1 mm and half of it; give more than 2 mm",
            options.line_width));
  if (!(options.radius > 1 && options.radius < options.line_width / 2))
    return fail(ErrorCode::invalid,
                fmt::format("Algorithm 1: radius {} mm is not between 1 mm and half the line width, {} mm",
                            options.radius, options.line_width / 2));
  return {};
}

InscribedTriangle inscribed_triangle(std::span<const Eigen::Vector3f> points, const Eigen::Vector3d& tip,
                                     const Eigen::Vector3d& view, const Algorithm1Options& options) {
  const Search search{points, tip, options.radius, options.line_width / 2};
  InscribedTriangle result;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto vertex = search.next(std::span(result.vertices).first(i));
    if (!vertex) return fallback(view);
    result.vertices[i] = vertex->point;
    result.worst_cost = std::max(result.worst_cost, vertex->cost);
  }
  const auto& [s1, s2, s3] = result.vertices;
  const Eigen::Vector3d n = (s2 - s1).cross(s3 - s2);
  if (!(n.norm() > 0)) return fallback(view);
  result.found = true;
  result.normal = n.dot(view) > 0 ? Eigen::Vector3d(-n.normalized()) : Eigen::Vector3d(n.normalized());
  return result;
}

}  // namespace linescope
