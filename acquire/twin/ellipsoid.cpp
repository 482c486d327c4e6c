#include "acquire/twin/ellipsoid.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>

namespace linescope::twin {
namespace {

using Eigen::Vector3d;

// g(t) = sum (a_i y_i / (t + a_i^2))^2 - 1: its largest root gives the foot of the perpendicular from y.
double g(const Vector3d& axes, const Vector3d& y, double t) {
  double sum = -1;
  for (int i = 0; i < 3; ++i) {
    const double term = axes[i] * y[i] / (t + axes[i] * axes[i]);
    sum += term * term;
  }
  return sum;
}

double perpendicular_parameter(const Vector3d& axes, const Vector3d& y) {
  const double smallest = axes.minCoeff();
  // Bracket: at `low` the term of the smallest axis alone reaches 1, at `high` all three together cannot.
  Eigen::Index k = 0;
  axes.minCoeff(&k);
  double low = -smallest * smallest + smallest * y[k];
  double high = -smallest * smallest + axes.cwiseProduct(y).norm();
  for (int i = 0; i < 200 && high - low > 1e-15 * (1 + std::abs(high)); ++i) {
    const double middle = 0.5 * (low + high);
    (g(axes, y, middle) > 0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

Ellipsoid::Ellipsoid(const Vector3d& semi_axes, const Vector3d& centre)
    : axes_(semi_axes), inverse_axes_(semi_axes.cwiseInverse()), centre_(centre) {}

bool Ellipsoid::cast(const Vector3d& origin, const Vector3d& direction, Hit& hit) const {
  const Vector3d o = (origin - centre_).cwiseProduct(inverse_axes_);
  const Vector3d d = direction.cwiseProduct(inverse_axes_);
  const double a = d.squaredNorm(), b = o.dot(d), c = o.squaredNorm() - 1;
  const double root = b * b - a * c;
  if (root < 0) return false;
  const double t = (-b - std::sqrt(root)) / a;
  if (!(t > 0)) return false;
  hit.distance = t;
  hit.normal = normal_of_surface_point(origin + t * direction - centre_);
  return true;
}

Vector3d Ellipsoid::normal_of_surface_point(const Vector3d& from_centre) const {
  return from_centre.cwiseProduct(inverse_axes_).cwiseProduct(inverse_axes_).normalized();
}

Vector3d Ellipsoid::nearest(const Vector3d& point) const {
  const Vector3d from_centre = point - centre_;
  // In the first octant; a nudge off the axes keeps points of symmetry, where the foot is not unique, well
  // defined.
  const Vector3d y = from_centre.cwiseAbs().cwiseMax(1e-12);
  const double t = perpendicular_parameter(axes_, y);
  Vector3d foot;
  for (int i = 0; i < 3; ++i) {
    const double magnitude = axes_[i] * axes_[i] * y[i] / (t + axes_[i] * axes_[i]);
    foot[i] = std::copysign(magnitude, from_centre[i]);
  }
  return foot + centre_;
}

double Ellipsoid::distance(const Vector3d& point) const {
  const double length = (point - nearest(point)).norm();
  const bool outside = (point - centre_).cwiseProduct(inverse_axes_).squaredNorm() >= 1;
  return outside ? length : -length;
}

Vector3d Ellipsoid::normal(const Vector3d& point) const {
  return normal_of_surface_point(nearest(point) - centre_);
}

std::string Ellipsoid::json() const {
  return fmt::format(R"({{"kind":"ellipsoid","semi_axes_mm":[{},{},{}],"centre_mm":[{},{},{}]}})", axes_.x(),
                     axes_.y(), axes_.z(), centre_.x(), centre_.y(), centre_.z());
}

}  // namespace linescope::twin
