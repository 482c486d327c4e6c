// How bright the laser makes a point of the surface.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "acquire/twin/laser_sheet.hpp"
#include "acquire/twin/optics_options.hpp"

namespace linescope::twin {

class LaserLight {
 public:
  LaserLight(std::uint64_t seed, const LaserSheet& sheet, const OpticsOptions& options);

  /// Grey levels on a white surface with the unit normal `normal` at `point` (camera's frame), `seconds`
  /// since the beginning; without speckle and without shade.
  double level(const SheetPlace& place, const Eigen::Vector3d& normal, double seconds) const;

  /// Share of the light that soft tissue lets pass.
  double passing(double fan_angle, double seconds) const;

  /// Offsets from the sheet (mm) between which there is light, at `distance` from the source.
  struct Band {
    double low, high;
  };
  Band band(double distance) const;

  /// False when there is no light at `place`, even if the sheet moved by `shift` mm.
  bool touches(const SheetPlace& place, double shift) const;

  const LaserSheet& sheet() const { return sheet_; }

 private:
  double sigma(double distance) const;

  std::uint64_t seed_;
  const LaserSheet& sheet_;
  LineOptions line_;
  TroubleOptions trouble_;
  double missing_threshold_;
};

}  // namespace linescope::twin
