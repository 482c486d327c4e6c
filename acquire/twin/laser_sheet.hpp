// The sheet of light in the camera's frame (OpenCV: y down, z forward; mm): where it is, how bright, where it
// comes from.
#pragma once

#include <Eigen/Core>
#include <memory>

#include "acquire/twin/instrument_options.hpp"
#include "acquire/twin/optics_options.hpp"
#include "common/result.hpp"

namespace linescope::twin {

/// How a point lies to the sheet.
struct SheetPlace {
  double offset = 0;          ///< mm, signed distance from the sheet, exact to first order
  double fan_angle = 0;       ///< rad, of the ray through the point's foot against the fan's middle
  double distance = 0;        ///< mm, from the fan's source along the ray
  Eigen::Vector3d direction;  ///< unit, in which the light travels there
};

class LaserSheet {
 public:
  virtual ~LaserSheet() = default;
  virtual SheetPlace at(const Eigen::Vector3d& point) const = 0;
};

/// A plane: y_down = z tan(alpha) - b, with its source at the fibre's tip (0, -b, 0).
class FlatSheet : public LaserSheet {
 public:
  FlatSheet(double baseline_mm, double alpha_rad);
  SheetPlace at(const Eigen::Vector3d& point) const override;

 private:
  double baseline_, sine_, cosine_;
};

/// The plane, or the sheet traced through the prism when the options say so. Fails when the prism cannot give
/// the deviation or reflects totally (acquire/twin/prism.hpp).
Result<std::unique_ptr<LaserSheet>> make_sheet(const InstrumentOptions& instrument,
                                               const PrismOptions& prism);

}  // namespace linescope::twin
