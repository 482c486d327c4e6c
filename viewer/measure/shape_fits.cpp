#include "viewer/measure/shape_fits.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <numbers>

namespace linescope {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix4d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector4d;

constexpr int kSteps = 30;
constexpr std::size_t kPointsForAxis = 1500;

template <class Points>
auto mean_of(const Points& points) {
  typename Points::value_type sum = Points::value_type::Zero();
  for (const auto& p : points) sum += p;
  return typename Points::value_type(sum / static_cast<double>(points.size()));
}

/// Circle in the plane, or sphere in space.
template <class Points, class Round>
double deviation_from(const Points& points, const Round& round) {
  double squares = 0;
  for (const auto& p : points) {
    const double e = (p - round.centre).norm() - round.radius;
    squares += e * e;
  }
  return std::sqrt(squares / static_cast<double>(points.size()));
}

/// Solves the normal equations; nothing when they do not determine all unknowns.
template <class Matrix, class Vector>
std::optional<Vector> solved(const Matrix& normal, const Vector& right) {
  const Eigen::FullPivLU<Matrix> lu(normal);
  if (!lu.isInvertible()) return std::nullopt;
  return Vector(lu.solve(right));
}

std::optional<FittedBall> algebraic_ball(const Points3& points) {
  if (points.size() < 4) return std::nullopt;
  const Vector3d mean = mean_of(points);
  Matrix4d normal = Matrix4d::Zero();
  Vector4d right = Vector4d::Zero();
  for (const Vector3d& p : points) {
    Vector4d row;
    row << p - mean, 1;
    normal += row * row.transpose();
    right += row * (p - mean).squaredNorm();
  }
  const auto s = solved(normal, right);
  if (!s) return std::nullopt;
  const Vector3d centre = 0.5 * s->head<3>();
  return FittedBall{mean + centre, std::sqrt(std::max(0.0, s->w() + centre.squaredNorm())), 0};
}

/// Some of the points, evenly taken: the search for an axis needs no more.
Points3 thinned(const Points3& points) {
  const std::size_t step = points.size() / kPointsForAxis + 1;
  Points3 some;
  for (std::size_t i = 0; i < points.size(); i += step) some.push_back(points[i]);
  return some;
}

double misfit(const Points3& points, const Vector3d& axis) {
  const auto circle = algebraic_circle(shadow(points, axis));
  // A shadow that is nearly a line is fitted by ever larger circles: no cylinder that anybody scans.
  if (!circle || circle->radius > 500) return std::numeric_limits<double>::infinity();
  return circle->deviation;
}

Vector3d tilted(const Vector3d& axis, double angle, double azimuth) {
  const Vector3d across = axis.unitOrthogonal();
  const Vector3d hinge = Eigen::AngleAxisd(azimuth, axis) * across;
  return Eigen::AngleAxisd(angle, hinge) * axis;
}

/// The best of the directions `angle` around `axis`, or `axis` itself.
Vector3d improved(const Points3& points, const Vector3d& axis, double angle, double& best) {
  Vector3d found = axis;
  for (int i = 0; i < 8; ++i) {
    const Vector3d candidate = tilted(axis, angle, i * std::numbers::pi / 4);
    const double m = misfit(points, candidate);
    if (m < best) {
      best = m;
      found = candidate;
    }
  }
  return found;
}

}  // namespace

std::optional<Circle> algebraic_circle(const Points2& points) {
  if (points.size() < 3) return std::nullopt;
  const Vector2d mean = mean_of(points);
  Matrix3d normal = Matrix3d::Zero();
  Vector3d right = Vector3d::Zero();
  for (const Vector2d& p : points) {
    const Vector2d q = p - mean;
    const Vector3d row(q.x(), q.y(), 1);
    normal += row * row.transpose();
    right += row * q.squaredNorm();
  }
  const auto s = solved(normal, right);
  if (!s) return std::nullopt;
  Circle circle;
  const Vector2d centre = 0.5 * s->head<2>();
  circle.radius = std::sqrt(std::max(0.0, s->z() + centre.squaredNorm()));
  circle.centre = mean + centre;
  circle.deviation = deviation_from(points, circle);
  return circle;
}

std::optional<Circle> geometric_circle(const Points2& points) {
  auto circle = algebraic_circle(points);
  for (int step = 0; circle && step < kSteps; ++step) {
    Matrix3d normal = Matrix3d::Zero();
    Vector3d right = Vector3d::Zero();
    for (const Vector2d& p : points) {
      const Vector2d out = p - circle->centre;
      const double length = out.norm();
      if (!(length > 0)) continue;
      const Vector3d row(-out.x() / length, -out.y() / length, -1);
      normal += row * row.transpose();
      right -= row * (length - circle->radius);
    }
    const auto change = solved(normal, right);
    if (!change) return std::nullopt;
    circle->centre += change->head<2>();
    circle->radius += change->z();
    if (change->norm() < 1e-9) break;
  }
  if (circle) circle->deviation = deviation_from(points, *circle);
  return circle;
}

std::optional<Parabola> fitted_parabola(const Points2& points) {
  if (points.size() < 3) return std::nullopt;
  Matrix3d normal = Matrix3d::Zero();
  Vector3d right = Vector3d::Zero();
  for (const Vector2d& p : points) {
    const Vector3d row(p.x() * p.x(), p.x(), 1);
    normal += row * row.transpose();
    right += row * p.y();
  }
  const auto s = solved(normal, right);
  if (!s) return std::nullopt;
  return Parabola{s->x(), s->y(), s->z()};
}

std::optional<FittedWall> fitted_wall(const Points3& points) {
  if (points.size() < 3) return std::nullopt;
  FittedWall wall;
  wall.centre = mean_of(points);
  Matrix3d scatter = Matrix3d::Zero();
  for (const Vector3d& p : points) scatter += (p - wall.centre) * (p - wall.centre).transpose();
  const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(scatter);
  wall.normal = solver.eigenvectors().col(0);
  wall.deviation = std::sqrt(std::max(0.0, solver.eigenvalues()[0]) / static_cast<double>(points.size()));
  return wall;
}

std::optional<FittedBall> fitted_ball(const Points3& points) {
  auto ball = algebraic_ball(points);
  for (int step = 0; ball && step < kSteps; ++step) {
    Matrix4d normal = Matrix4d::Zero();
    Vector4d right = Vector4d::Zero();
    for (const Vector3d& p : points) {
      const Vector3d out = p - ball->centre;
      const double length = out.norm();
      if (!(length > 0)) continue;
      Vector4d row;
      row << -out / length, -1;
      normal += row * row.transpose();
      right -= row * (length - ball->radius);
    }
    const auto change = solved(normal, right);
    if (!change) return std::nullopt;
    ball->centre += change->head<3>();
    ball->radius += change->w();
    if (change->norm() < 1e-9) break;
  }
  if (ball) ball->deviation = deviation_from(points, *ball);
  return ball;
}

Points2 shadow(const Points3& points, const Vector3d& axis) {
  const Vector3d u = axis.unitOrthogonal(), v = axis.cross(u);
  Points2 flat;
  flat.reserve(points.size());
  for (const Vector3d& p : points) flat.emplace_back(u.dot(p), v.dot(p));
  return flat;
}

std::optional<FittedCylinder> fitted_cylinder(const Points3& points) {
  if (points.size() < 6) return std::nullopt;
  const Points3 some = thinned(points);
  const auto wall = fitted_wall(some);
  // The axis of a scanned strip lies along the strip's tangent plane: half a turn of candidates in it, then
  // ever smaller steps to all sides.
  Vector3d axis = wall->normal.unitOrthogonal();
  double best = std::numeric_limits<double>::infinity();
  const Vector3d first = axis;
  for (int i = 0; i < 36; ++i) {
    const Vector3d candidate = Eigen::AngleAxisd(i * std::numbers::pi / 36, wall->normal) * first;
    const double m = misfit(some, candidate);
    if (m < best) {
      best = m;
      axis = candidate;
    }
  }
  for (double angle = 0.05; angle > 1e-5; angle *= 0.6) axis = improved(some, axis, angle, best);
  const auto section = geometric_circle(shadow(points, axis));
  if (!section) return std::nullopt;
  return FittedCylinder{axis, *section};
}

}  // namespace linescope
