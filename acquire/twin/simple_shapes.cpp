#include "acquire/twin/simple_shapes.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace linescope::twin {

using Eigen::Vector3d;

bool PlaneBody::cast(const Vector3d& origin, const Vector3d& direction, Hit& hit) const {
  if (!(direction.z() < 0)) return false;
  const double t = (height_ - origin.z()) / direction.z();
  if (!(t > 0)) return false;
  hit.distance = t;
  hit.normal = Vector3d::UnitZ();
  return true;
}

std::string PlaneBody::json() const {
  return fmt::format(R"({{"kind":"plane","height_mm":{}}})", height_);
}

bool CylinderBody::cast(const Vector3d& origin, const Vector3d& direction, Hit& hit) const {
  const Vector3d o = from_axis(origin), d{direction.x(), 0, direction.z()};
  const double a = d.squaredNorm(), b = o.dot(d), c = o.squaredNorm() - radius_ * radius_;
  const double root = b * b - a * c;
  if (root < 0 || !(a > 0)) return false;
  const double t = (-b - std::sqrt(root)) / a;
  if (!(t > 0)) return false;
  hit.distance = t;
  hit.normal = (o + t * d) / radius_;
  return true;
}

double CylinderBody::distance(const Vector3d& point) const {
  return from_axis(point).norm() - radius_;
}

Vector3d CylinderBody::normal(const Vector3d& point) const {
  const Vector3d out = from_axis(point);
  const double length = out.norm();
  return length > 0 ? Vector3d(out / length) : Vector3d::UnitZ();
}

std::string CylinderBody::json() const {
  return fmt::format(R"({{"kind":"cylinder","diameter_mm":{},"axis":[0,1,0],"axis_point_mm":[0,0,{}]}})",
                     2 * radius_, -radius_);
}

bool UnionBody::cast(const Vector3d& origin, const Vector3d& direction, Hit& hit) const {
  bool found = false;
  Hit candidate;
  for (const auto& part : parts_) {
    if (!part->cast(origin, direction, candidate)) continue;
    if (found && candidate.distance >= hit.distance) continue;
    hit = candidate;
    found = true;
  }
  return found;
}

const Phantom& UnionBody::nearest_part(const Vector3d& point) const {
  return **std::min_element(parts_.begin(), parts_.end(), [&](const auto& a, const auto& b) {
    return a->distance(point) < b->distance(point);
  });
}

double UnionBody::distance(const Vector3d& point) const {
  return nearest_part(point).distance(point);
}

Vector3d UnionBody::normal(const Vector3d& point) const {
  return nearest_part(point).normal(point);
}

std::string UnionBody::json() const {
  std::string list;
  for (const auto& part : parts_) list += (list.empty() ? "" : ",") + part->json();
  return fmt::format(R"({{"kind":"union","parts":[{}]}})", list);
}

}  // namespace linescope::twin
