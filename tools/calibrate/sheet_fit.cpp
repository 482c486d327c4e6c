#include "tools/calibrate/sheet_fit.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <random>

#include "tools/calibrate/sample_statistics.hpp"

namespace linescope::calibrate {
namespace {

/// As many as the form has, without going to the heap for every point.
using SomeTerms = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 10, 1>;
using SquareOfTerms = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 10, 10>;

SheetTerms terms_of(double x, double y) {
  SheetTerms terms;
  terms << x, y, 1, x * x, x * y, y * y, x * x * x, x * x * y, x * y * y, y * y * y;
  return terms;
}

/// Change of the misfit in 1/z for one pixel along the profile: the surface's 1/z changes and the board's
/// does.
double per_pixel(const Sheet& sheet, const LaserPoint& p) {
  return sheet.slope(p.x, p.y).dot(p.step) - p.inverse_step;
}

std::vector<const LaserPoint*> all_points(const std::vector<const LaserPicture*>& pictures) {
  std::vector<const LaserPoint*> points;
  for (const LaserPicture* picture : pictures)
    for (const LaserPoint& p : picture->points) points.push_back(&p);
  return points;
}

std::optional<Sheet> plane_through(const LaserPoint& a, const LaserPoint& b, const LaserPoint& c) {
  Eigen::Matrix3d rays;
  rays << a.x, a.y, 1, b.x, b.y, 1, c.x, c.y, 1;
  const Eigen::FullPivLU<Eigen::Matrix3d> lu(rays);
  if (!lu.isInvertible()) return std::nullopt;
  Sheet sheet;
  sheet.c.head<3>() = lu.solve(Eigen::Vector3d(a.inverse_depth, b.inverse_depth, c.inverse_depth));
  return sheet;
}

/// The plane with the most points close to it. Two points of one picture and one of another: the lines of two
/// pictures fix a plane, three points of one picture fix none. A fixed seed: same pictures, same result.
std::optional<Sheet> start_plane(const std::vector<const LaserPicture*>& pictures, const SheetFitOptions& o) {
  const auto points = all_points(pictures);
  std::mt19937 dice(20260101);
  const auto pick = [&](const LaserPicture& picture) -> const LaserPoint& {
    return picture.points[dice() % picture.points.size()];
  };
  std::optional<Sheet> best;
  double best_score = -1;
  const std::size_t stride = std::max<std::size_t>(1, points.size() / 2000);
  for (int trial = 0; trial < o.trials; ++trial) {
    const LaserPicture& one = *pictures[dice() % pictures.size()];
    const LaserPicture& other = *pictures[dice() % pictures.size()];
    if (&one == &other) continue;
    const auto sheet = plane_through(pick(one), pick(one), pick(other));
    if (!sheet) continue;
    double score = 0;
    for (std::size_t i = 0; i < points.size(); i += stride) {
      const double r = sheet->pixels(*points[i]) / (2 * o.inlier_px);
      if (std::abs(r) < 1) score += (1 - r * r) * (1 - r * r);
    }
    if (score > best_score) best_score = score, best = sheet;
  }
  return best;
}

/// Tukey's weights: nothing beyond the limit.
Eigen::VectorXd weights_for(const Sheet& sheet, const std::vector<const LaserPoint*>& points, double least) {
  std::vector<double> misfits(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) misfits[i] = std::abs(sheet.pixels(*points[i]));
  const double limit = std::max(least, 4.685 * 1.4826 * median_of(misfits));
  Eigen::VectorXd weights(static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double r = misfits[i] / limit;
    weights(static_cast<Eigen::Index>(i)) = r < 1 ? (1 - r * r) * (1 - r * r) : 0;
  }
  return weights;
}

/// Least squares in pixels with the given weights; false: the points fix no surface.
bool improve(Sheet& sheet, const std::vector<const LaserPoint*>& points, const Eigen::VectorXd& weights,
             int coefficients) {
  SquareOfTerms normal = SquareOfTerms::Zero(coefficients, coefficients);
  SomeTerms right = SomeTerms::Zero(coefficients);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double slope = per_pixel(sheet, *points[i]);
    const double w = weights(static_cast<Eigen::Index>(i)) / std::max(slope * slope, 1e-18);
    const SomeTerms row = terms_of(points[i]->x, points[i]->y).head(coefficients);
    normal.noalias() += w * row * row.transpose();
    right.noalias() += w * points[i]->inverse_depth * row;
  }
  const SomeTerms scale = normal.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigen::FullPivLU<SquareOfTerms> lu(scale.asDiagonal() * normal * scale.asDiagonal());
  if (lu.rcond() < 1e-14) return false;
  sheet.c.setZero();
  sheet.c.head(coefficients) = scale.asDiagonal() * lu.solve(scale.asDiagonal() * right);
  return sheet.c.allFinite();
}

}  // namespace

double Sheet::inverse_depth(double x, double y) const {
  // Written out: a fit asks this hundreds of millions of times.
  return c(2) + x * (c(0) + x * (c(3) + x * c(6) + y * c(7))) +
         y * (c(1) + x * c(4) + y * (c(5) + x * c(8) + y * c(9)));
}

Eigen::Vector2d Sheet::slope(double x, double y) const {
  return {c(0) + x * (2 * c(3) + 3 * x * c(6) + 2 * y * c(7)) + y * (c(4) + y * c(8)),
          c(1) + y * (2 * c(5) + 3 * y * c(9) + 2 * x * c(8)) + x * (c(4) + x * c(7))};
}

double Sheet::distance(const LaserPoint& p) const {
  const double q = inverse_depth(p.x, p.y);
  const Eigen::Vector2d by = slope(p.x, p.y);
  const Eigen::Vector3d gradient(by.x(), by.y(), q - p.x * by.x() - p.y * by.y());
  return (q / p.inverse_depth - 1) / gradient.norm();
}

double Sheet::pixels(const LaserPoint& p) const {
  const double slope = per_pixel(*this, p);
  return (inverse_depth(p.x, p.y) - p.inverse_depth) / (std::abs(slope) < 1e-9 ? 1e-9 : slope);
}

std::optional<Sheet> fit_sheet(const std::vector<const LaserPicture*>& pictures, SheetForm form,
                               const SheetFitOptions& options, std::vector<std::vector<bool>>* inliers) {
  auto sheet = start_plane(pictures, options);
  if (!sheet) return std::nullopt;
  const auto points = all_points(pictures);
  Eigen::VectorXd weights;
  for (int round = 0; round < 15; ++round) {
    weights = weights_for(*sheet, points, options.inlier_px);
    // The first rounds as a plane: a bent form must not begin by bending towards outliers.
    if (!improve(*sheet, points, weights, round < 4 ? 3 : static_cast<int>(form))) return std::nullopt;
  }
  if (!inliers) return sheet;
  inliers->clear();
  Eigen::Index i = 0;
  for (const LaserPicture* picture : pictures) {
    auto& flags = inliers->emplace_back();
    for (std::size_t k = 0; k < picture->points.size(); ++k) flags.push_back(weights(i++) > 0);
  }
  return sheet;
}

LaserPlane plane_of(const Sheet& sheet) {
  // 1/z = c . (x, y, 1) is c . p = 1.
  const Eigen::Vector3d c = sheet.c.head<3>();
  return laser_plane_from_opencv({c.x(), c.y(), c.z(), -1}).value_or(LaserPlane{});
}

LaserBend bend_of(const Sheet& sheet) {
  LaserBend bend;
  for (std::size_t i = 0; i < LaserBend::kCubic; ++i) bend.b[i] = sheet.c(3 + static_cast<Eigen::Index>(i));
  return turned_over(bend);
}

Sheet sheet_of(const LaserPlane& plane, const LaserBend& bend) {
  Sheet sheet;
  const Eigen::Vector4d n = opencv_from_laser_plane(plane);
  sheet.c.head<3>() = -n.head<3>() / n(3);
  sheet.c.tail<7>() = Eigen::Map<const Eigen::Matrix<double, 7, 1>>(turned_over(bend).b.data());
  return sheet;
}

}  // namespace linescope::calibrate
