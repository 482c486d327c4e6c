// What the surface looks like in white light: colour, texture, blood.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "acquire/twin/optics_options.hpp"

namespace linescope::twin {

class Tissue {
 public:
  Tissue(std::uint64_t seed, const LightOptions& light, const TroubleOptions& trouble);

  /// Share of light that comes back, blue green red, at a place of the phantom.
  Eigen::Vector3d albedo(const Eigen::Vector3d& place) const;

 private:
  std::uint64_t seed_;
  double texture_;
  double blood_threshold_;
};

}  // namespace linescope::twin
