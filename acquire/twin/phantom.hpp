// A surface the twin can look at: rays in, hits out; and the truth about it.
//
// Phantom frame, mm: the origin lies on the surface in the middle of the donor site, z points out of the
// surface there, x along the site (the way of a sweep), y across. Implementations are immutable.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>

#include "acquire/twin/paint.hpp"
#include "acquire/twin/phantom_kind.hpp"
#include "common/result.hpp"

namespace linescope::twin {

struct PhantomFrame {};  ///< tag for Rigid

struct Hit {
  double distance = 0;     ///< mm along the ray
  Eigen::Vector3d normal;  ///< unit, out of the surface
};

class Phantom {
 public:
  virtual ~Phantom() = default;

  /// Nearest surface point in front of `origin` (outside the body) along the unit vector `direction`.
  virtual bool cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, Hit& hit) const = 0;

  /// Signed distance to the surface, positive outside; exact up to rounding.
  virtual double distance(const Eigen::Vector3d& point) const = 0;

  /// Unit normal at the surface point nearest to `point`.
  virtual Eigen::Vector3d normal(const Eigen::Vector3d& point) const = 0;

  /// True when no part of the body can shade another part that faces the light.
  virtual bool convex() const = 0;

  /// What is printed on it; null: it looks like tissue. Lives as long as the phantom.
  virtual const Paint* paint() const { return nullptr; }

  /// The surface as a JSON object: kind and numbers.
  virtual std::string json() const = 0;
};

/// Fails for meshes that make no body (triangle_phantom.hpp says which); analytic shapes fail on impossible
/// sizes only.
Result<std::shared_ptr<const Phantom>> make_phantom(const PhantomOptions& options);

}  // namespace linescope::twin
