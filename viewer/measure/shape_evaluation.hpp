// The thesis's "precision evaluation": a shape of known kind is fitted to measured points, and what is left
// over, the fitted diameter and its difference from the nominal one are told. Millimetres, any frame.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "common/result.hpp"
#include "viewer/measure/shape_fits.hpp"

namespace linescope {

enum class Shape : std::uint8_t { plane, cylinder, sphere };
inline constexpr Shape kShapes[] = {Shape::plane, Shape::cylinder, Shape::sphere};
/// "plane", "cylinder", "sphere"
const char* name(Shape shape);

/// All points, or those of a ball around a picked place.
struct Region {
  bool all = true;
  Eigen::Vector3d centre{0, 0, 0};
  double radius = 5;  ///< mm
};

struct ShapeEvaluation {
  Shape shape = Shape::plane;
  Region region;
  std::size_t points = 0;
  double mean = 0;       ///< of the signed distances from the fitted shape (plane: from the side seen), mm
  double mean_size = 0;  ///< of their sizes
  double deviation = 0;  ///< standard deviation of the signed distances (n - 1)
  double maximum = 0;    ///< the largest size
  double diameter = 0;   ///< fitted; 0: a plane has none
  double nominal = 0;    ///< diameter given by the operator; 0: none given
  Eigen::Vector3d centre{0, 0,
                         0};  ///< of plane (mean of the points) or sphere, a point of the cylinder's axis
  Eigen::Vector3d direction{0, 0, 1};  ///< the plane's normal or the cylinder's axis, unit, either way

  bool has_diameter() const { return shape != Shape::plane; }
  bool has_difference() const { return has_diameter() && nominal > 0; }
  /// Fitted minus nominal diameter, mm.
  double difference() const { return diameter - nominal; }
  /// The same, per cent of the nominal one.
  double difference_percent() const { return 100 * difference() / nominal; }
};

/// The points of the region; those that are not finite are left out.
Points3 points_in(std::span<const Eigen::Vector3f> points, const Region& region);

/// The cylinder is the thesis's circle (Eqs 4.16, 4.17) with an axis nobody has to know. Refused with a
/// sentence: fewer than 10 points, points that do not determine the shape, a nominal diameter that is none.
/// Takes about a second per million points; any thread.
Result<ShapeEvaluation> evaluate_shape(std::span<const Eigen::Vector3f> points, Shape shape,
                                       const Region& region, double nominal_diameter = 0);

/// "cylinder: 49.21 mm (nominal 49.00, +0.21 mm, +0.4 %); distances mean 0.000, SD 0.120, maximum 0.510 mm;
/// 12,345 points"
std::string sentence(const ShapeEvaluation& evaluation);

}  // namespace linescope
