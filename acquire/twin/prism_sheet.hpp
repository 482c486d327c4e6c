// The sheet as it really leaves the prism: every ray of the fan refracted in space (Snell in vector form).
// Rays off the fan's middle meet the inclined face at a larger angle and are bent more: the sheet is no
// plane.
//
// Camera's frame (y down, z forward), mm. The fan starts at the fibre's tip, crosses a little air, enters the
// first face (perpendicular to the optical axis), and leaves the inclined face on the line y = -b, z = 0.
#pragma once

#include <optional>
#include <vector>

#include "acquire/twin/laser_sheet.hpp"

namespace linescope::twin {

/// One ray behind the prism.
struct SheetRay {
  Eigen::Vector3d origin;     ///< where it leaves the prism
  Eigen::Vector3d direction;  ///< unit
};

class PrismSheet : public LaserSheet {
 public:
  /// The apex is the one that bends the fan's middle by `alpha_rad` (Eq 3.9). Fails when there is none.
  static Result<PrismSheet> create(double baseline_mm, double alpha_rad, const PrismOptions& options);

  SheetPlace at(const Eigen::Vector3d& point) const override;

  /// The ray that enters face 1 at `angle_in_air` against its normal, sideways; nothing when face 2 reflects
  /// it totally.
  std::optional<SheetRay> ray(double angle_in_air) const;

  /// The same by its sideways angle behind the prism.
  std::optional<SheetRay> ray_in_medium(double angle) const;

  double apex() const { return apex_; }

 private:
  PrismSheet(double baseline_mm, double apex, const PrismOptions& options);
  SheetRay ray_with_sine(double sine_in_medium) const;
  double largest_sine() const;

  // What the search for a point's ray needs of the ray with one sine: where it starts sideways, how it runs
  // per depth, and how these change with the sine. Tabulated, because the renderer asks some ten thousand
  // times per picture.
  struct Run {
    double x, dx_dz, dy_dz;
  };
  struct Knot {
    Run value, slope;
  };
  Run run_of(double sine) const;
  void tabulate();
  Knot interpolated(double sine) const;

  double baseline_;
  double apex_;
  PrismOptions options_;
  Eigen::Vector3d face_normal_;
  double largest_sine_ = 0;
  std::vector<Knot> knots_;
};

}  // namespace linescope::twin
