// The middle of a line profile by a matched Gaussian: the maximum-likelihood place for a Gaussian line in
// white noise.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "acquire/laser/light_window.hpp"

namespace linescope {

struct GaussFit {
  float centre = 0;      ///< px along the profile
  float amplitude = 0;   ///< grey levels of the light that was asked for
  bool settled = false;  ///< false: it wandered off, or there is no light; centre is then the start
};

/// Light that somebody has gathered already: values from pixel `begin` of the profile on. May be empty.
struct StoredLight {
  std::span<const std::int16_t> values;
  int begin = 0;
};

/// Tables are built once; fit() allocates nothing after the longest window was seen. One thread per object.
class GaussCentre {
 public:
  GaussCentre();

  /// `start`: within about a sigma of the middle. `sigma`: of the line, px. `noise`: grey levels; decides
  /// whether a slope of the background is real. `mix`: the light to look at; `stored` holds it where it is at
  /// hand, the rest is read from the profile.
  GaussFit fit(const Profile& profile, float start, float sigma, float noise, const LightMix& mix,
               const StoredLight& stored);

 private:
  static constexpr int kPhases = 16;
  struct Kernel {
    float sigma = 1;
    int radius = 0;             ///< taps reach from -radius to +radius
    std::size_t taps = 0;       ///< rounded up for vectors; those beyond the radius weigh nothing
    std::vector<float> weight;  ///< [phase][tap]
    std::vector<float> moment;  ///< weight times distance from the centre
    struct Totals {
      float weight = 0, moment = 0, spread = 0;  ///< sums of w, w t, w t^2
      float power = 0;                           ///< sum of w^2
    };
    std::array<Totals, kPhases> totals{};
  };
  /// Where the window lies: `count` bins of `bin` pixels from pixel `first`, the background from bin `begin`
  /// to `end` away.
  struct Frame {
    int first = 0, bin = 1, count = 0, begin = 0, end = 0;
    float index_of(float px) const {
      return (px - static_cast<float>(first)) / static_cast<float>(bin) - half_bin();
    }
    float px_of(float index) const {
      return static_cast<float>(first) + (index + half_bin()) * static_cast<float>(bin);
    }
    float half_bin() const { return 0.5F * static_cast<float>(bin - 1) / static_cast<float>(bin); }
  };
  const Kernel& kernel_for(float sigma) const;
  Frame frame_for(const Kernel& kernel, float start, int bin) const;
  void gather(const Profile& profile, const Frame& frame, const LightMix& mix);
  bool take(const StoredLight& stored, const Frame& frame);
  void add_channel(const Profile& profile, const Frame& frame, std::size_t channel, float share);
  /// Level at index 0 and rise per bin.
  struct Background {
    float level = 0, slope = 0;
  };
  Background background(const Frame& frame, float middle, float noise) const;
  GaussFit climb(const Kernel& kernel, const Frame& frame, const Background& background, float start) const;

  std::vector<Kernel> kernels_;
  std::vector<std::uint8_t> index_;  ///< of the kernel, by sigma in steps of kStep
  std::vector<float> window_;
};

}  // namespace linescope
