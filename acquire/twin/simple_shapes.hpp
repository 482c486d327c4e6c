// Plane, cylinder and the union of several bodies.
#pragma once

#include <vector>

#include "acquire/twin/phantom.hpp"

namespace linescope::twin {

/// The plane z = height, body below it.
class PlaneBody : public Phantom {
 public:
  explicit PlaneBody(double height = 0) : height_(height) {}

  bool cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, Hit& hit) const override;
  double distance(const Eigen::Vector3d& point) const override { return point.z() - height_; }
  Eigen::Vector3d normal(const Eigen::Vector3d&) const override { return Eigen::Vector3d::UnitZ(); }
  bool convex() const override { return true; }
  std::string json() const override;

 private:
  double height_;
};

/// An endless cylinder along y, its top line through the origin: swept across its curvature, as the thesis
/// did (4.4.2).
class CylinderBody : public Phantom {
 public:
  explicit CylinderBody(double diameter) : radius_(0.5 * diameter) {}

  bool cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, Hit& hit) const override;
  double distance(const Eigen::Vector3d& point) const override;
  Eigen::Vector3d normal(const Eigen::Vector3d& point) const override;
  bool convex() const override { return true; }
  std::string json() const override;

 private:
  Eigen::Vector3d from_axis(const Eigen::Vector3d& point) const {
    return {point.x(), 0, point.z() + radius_};
  }

  double radius_;
};

/// Several bodies as one. Distances are exact outside; inside, where bodies overlap, they are a lower bound
/// of the depth.
class UnionBody : public Phantom {
 public:
  explicit UnionBody(std::vector<std::shared_ptr<const Phantom>> parts) : parts_(std::move(parts)) {}

  bool cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, Hit& hit) const override;
  double distance(const Eigen::Vector3d& point) const override;
  Eigen::Vector3d normal(const Eigen::Vector3d& point) const override;
  bool convex() const override { return false; }
  std::string json() const override;

 private:
  const Phantom& nearest_part(const Eigen::Vector3d& point) const;

  std::vector<std::shared_ptr<const Phantom>> parts_;
};

}  // namespace linescope::twin
