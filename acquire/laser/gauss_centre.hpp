// The middle of a line profile by a matched Gaussian: the maximum-likelihood place for a Gaussian line in
// white noise.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "acquire/laser/light_window.hpp"

namespace linescope {

struct GaussFit {
  float centre = 0;      ///< px along the profile
  float amplitude = 0;   ///< grey levels of the light that was asked for
  bool settled = false;  ///< false: it wandered off, or there is no light; centre is then the start
};

/// Tables are built once; fit() allocates nothing after the longest profile window was seen. One thread per
/// object.
class GaussCentre {
 public:
  GaussCentre();

  /// `start`: within about a sigma of the middle. `sigma`: of the line, px. `noise`: grey levels; decides
  /// whether a slope of the background is real. `mix`: the light to look at.
  GaussFit fit(const Profile& profile, float start, float sigma, float noise, const LightMix& mix);

 private:
  static constexpr int kPhases = 16;
  struct Kernel {
    float sigma = 1;
    int radius = 0;                      ///< taps reach from -radius to +radius
    std::vector<float> weight;           ///< [phase][tap]
    std::vector<float> moment;           ///< weight times distance from the centre
    std::array<float, kPhases> power{};  ///< sum of the squared weights
  };
  const Kernel& kernel_for(float sigma) const;
  void gather(const Profile& profile, int first, int count, int bin, const LightMix& mix);
  void subtract_background(int flank_begin, int flank_end, float middle, float noise);

  std::vector<Kernel> kernels_;
  std::vector<float> window_;
};

}  // namespace linescope
