// The middle of a line profile by a matched Gaussian: the maximum-likelihood place for a Gaussian line in
// white noise. Four profiles at a time.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "acquire/laser/light_window.hpp"

namespace linescope {

struct GaussFit {
  float centre = 0;      ///< px along the profile
  float amplitude = 0;   ///< grey levels of the light that was asked for
  bool settled = false;  ///< false: it wandered off, or there is no light; centre is then the start
};

/// Tables are built once; nothing is allocated after the most profiles and the widest line were seen. The
/// place found in a profile does not depend on the others. One thread per object.
class GaussCentre {
 public:
  GaussCentre();

  /// Starts a picture. `noise`: grey levels; decides whether a slope of the background is real.
  void begin(float noise);

  /// `start`: within about a sigma of the middle. `sigma`: of the line, px. `mix`: the light to look at.
  void add(const Profile& profile, float start, float sigma, const LightMix& mix);

  /// Of all profiles, in the order in which they were added.
  const std::vector<GaussFit>& fits();

 private:
  static constexpr std::size_t kLanes = 4;
  using Lanes = float __attribute__((vector_size(kLanes * sizeof(float))));

  struct Kernel {
    float sigma = 1;
    int half = 0;  ///< the window reaches from -half to +half
    int flank_begin = 0,
        flank_end = 0;          ///< distances from the middle that count as background, both included
    std::vector<float> weight;  ///< of the pixels 0 .. half from the middle
  };
  /// Where a profile's window lies: bins of `bin` pixels, the first from pixel `first` on.
  struct Frame {
    int first = 0, bin = 1, half = 0;
    float index_of(float px) const;  ///< in bins from the middle one
    float px_of(float index) const;
  };
  struct Light {
    Lanes weight{}, moment{};  ///< under the Gaussian, and times the distance from the window's middle
    Lanes power{};             ///< of the Gaussian, as if its weight were 1 at the window's middle
  };
  const Kernel& kernel_for(float sigma) const;
  void gather(const Profile& profile, const Frame& frame, std::size_t channel, float share);
  void take_background_out();
  Light below(Lanes place) const;
  void climb();

  std::vector<Kernel> kernels_;
  std::vector<std::uint8_t> index_;  ///< of the kernel, by sigma in steps of kStep
  float noise_ = 0;

  // The profiles that wait, all of one kernel.
  const Kernel* kernel_ = nullptr;
  std::size_t waiting_ = 0;
  std::array<Frame, kLanes> frames_{};
  Lanes start_{};
  std::vector<Lanes> window_;
  std::vector<GaussFit> fits_;
};

}  // namespace linescope
