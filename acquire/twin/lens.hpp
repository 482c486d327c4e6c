// The twin's own lens: which ray belongs to which pixel. Written apart from the product's camera model on
// purpose: an error there must not cancel against the same error here. OpenCV's frame and pixel convention
// (first pixel's centre is (0, 0)).
#pragma once

#include <Eigen/Core>
#include <optional>

#include "acquire/twin/instrument_options.hpp"

namespace linescope::twin {

class Lens {
 public:
  explicit Lens(const LensNumbers& numbers);

  /// Where the undistorted direction (x, y, 1) lands, px.
  Eigen::Vector2d pixel(const Eigen::Vector2d& xy) const;

  /// Slope (x, y) of the ray that lands on pixel (u, v). Nothing beyond the edge of the image circle, where
  /// the lens's polynomial folds back on itself: no light comes there.
  std::optional<Eigen::Vector2d> slope(double u, double v) const;

  const LensNumbers& numbers() const { return numbers_; }

 private:
  Eigen::Vector2d bent(const Eigen::Vector2d& xy) const;
  Eigen::Matrix2d bending(const Eigen::Vector2d& xy) const;

  LensNumbers numbers_;
};

}  // namespace linescope::twin
