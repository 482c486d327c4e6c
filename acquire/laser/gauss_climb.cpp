#include "acquire/laser/gauss_climb_body.hpp"

namespace linescope {
namespace {

void gather_plain(const GaussWindows& from, int count, GaussBatch& batch) {
  for (std::size_t lane = 0; lane < kGaussLanes; ++lane) {
    const std::uint8_t* p = from.picture + from.first[lane];
    for (int i = 0; i < count; ++i, p += from.step)
      batch.window[static_cast<std::size_t>(i)][lane] =
          from.wanted[lane] != 0 ? static_cast<float>(*p) : 0.0F;
  }
}

void climb_plain(const GaussKernel& kernel, float noise, GaussBatch& batch) {
  gauss_detail::climb(kernel, noise, batch);
}

}  // namespace

const GaussClimber& plain_gauss_climber() {
  static constexpr GaussClimber climber{&gather_plain, &climb_plain};
  return climber;
}

}  // namespace linescope
