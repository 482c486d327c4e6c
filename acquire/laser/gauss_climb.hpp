// Eight profiles under one Gaussian kernel: takes their background out and moves the Gaussians to where the
// light below them is balanced.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace linescope {

inline constexpr std::size_t kGaussLanes = 8;
using GaussLanes = float __attribute__((vector_size(kGaussLanes * sizeof(float))));
using GaussMask = std::int32_t __attribute__((vector_size(kGaussLanes * sizeof(std::int32_t))));

struct GaussKernel {
  float sigma = 1;
  int half = 0;  ///< the window reaches from -half to +half
  int flank_begin = 0,
      flank_end = 0;          ///< distances from the middle that count as background, both included
  std::vector<float> weight;  ///< of the pixels 0 .. half from the middle
};

struct GaussBatch {
  static constexpr std::size_t kLongest = 64;  ///< elements of the widest kernel's window, at most

  std::array<GaussLanes, kLongest> window{};  ///< in; destroyed
  GaussLanes start{};                         ///< in: index from the window's middle
  GaussLanes place{};                         ///< out, where settled
  GaussLanes amplitude{};                     ///< out, where settled
  GaussMask settled{};                        ///< out: all ones, or 0: wandered off, or no light
};

/// Where the gather finds the windows' pixels.
struct GaussWindows {
  const std::uint8_t* picture = nullptr;
  std::array<std::int32_t, kGaussLanes> first{};   ///< byte of the window's first pixel
  std::array<std::int32_t, kGaussLanes> wanted{};  ///< -1: yes, 0: leave this lane at 0
  int step = 0;                                    ///< bytes from pixel to pixel
};

/// One version's functions. All versions round alike: results are equal bit by bit.
struct GaussClimber {
  /// Fills the first `count` elements of the window. Four bytes are read at each pixel.
  void (*gather)(const GaussWindows& from, int count, GaussBatch& batch);
  /// `noise`: grey levels; decides whether a slope of the background is real.
  void (*climb)(const GaussKernel& kernel, float noise, GaussBatch& batch);
};

/// Plain C++, the definition.
const GaussClimber& plain_gauss_climber();
/// AVX2 where the processor has it, else the plain one.
const GaussClimber& fastest_gauss_climber();

}  // namespace linescope
