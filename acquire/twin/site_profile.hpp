// The donor site as the hand feels it: a smooth line of heights along the way of the sweep.
#pragma once

#include <Eigen/Core>

#include "acquire/twin/phantom.hpp"

namespace linescope::twin {

/// A polynomial z(x) fitted to the phantom along y = 0. A hand follows the form of a knee, not its facets.
class SiteProfile {
 public:
  /// Looks `half_length` mm to both sides of the site's middle.
  SiteProfile(const Phantom& phantom, double half_length);

  double height(double x) const;
  /// Unit, in the x-z plane, out of the surface.
  Eigen::Vector3d normal(double x) const;

 private:
  double clamped(double x) const;

  Eigen::Matrix<double, 5, 1> coefficients_;
  double half_length_;
};

}  // namespace linescope::twin
