// An ellipsoid whose top is the origin of the phantom's frame. Also serves as sphere; bumps of the mini knee
// are made of it.
#pragma once

#include "acquire/twin/phantom.hpp"

namespace linescope::twin {

class Ellipsoid : public Phantom {
 public:
  /// Semi-axes along x, y, z; all positive.
  Ellipsoid(const Eigen::Vector3d& semi_axes, const Eigen::Vector3d& centre);

  bool cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, Hit& hit) const override;
  double distance(const Eigen::Vector3d& point) const override;
  Eigen::Vector3d normal(const Eigen::Vector3d& point) const override;
  bool convex() const override { return true; }
  std::string json() const override;

  /// The surface point nearest to `point` (phantom frame).
  Eigen::Vector3d nearest(const Eigen::Vector3d& point) const;

 private:
  Eigen::Vector3d normal_of_surface_point(const Eigen::Vector3d& from_centre) const;

  Eigen::Vector3d axes_;
  Eigen::Vector3d inverse_axes_;
  Eigen::Vector3d centre_;
};

}  // namespace linescope::twin
