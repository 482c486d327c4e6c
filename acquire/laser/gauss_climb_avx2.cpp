#include "acquire/laser/gauss_climb_body.hpp"
#include "common/processor.hpp"

#if defined(__x86_64__)
#include <immintrin.h>

namespace linescope {
namespace {

// Without fused multiplications, which would round otherwise than the plain version.
#define LINESCOPE_AVX2 __attribute__((target("avx2")))

LINESCOPE_AVX2 void gather_avx2(const GaussWindows& from, int count, GaussBatch& batch) {
  const auto load = [](const auto& v) __attribute__((target("avx2"), always_inline)) {
    return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(v.data()));
  };
  const __m256i wanted = load(from.wanted), step = _mm256_set1_epi32(from.step);
  __m256i at = load(from.first);
  const auto* const picture = reinterpret_cast<const int*>(from.picture);
  for (int i = 0; i < count; ++i, at = _mm256_add_epi32(at, step)) {
    const __m256i bytes = _mm256_mask_i32gather_epi32(_mm256_setzero_si256(), picture, at, wanted, 1);
    const __m256 values = _mm256_cvtepi32_ps(_mm256_and_si256(bytes, _mm256_set1_epi32(255)));
    batch.window[static_cast<std::size_t>(i)] = values;
  }
}

LINESCOPE_AVX2 void climb_avx2(const GaussKernel& kernel, float noise, GaussBatch& batch) {
  gauss_detail::climb(kernel, noise, batch);
}

}  // namespace

const GaussClimber& fastest_gauss_climber() {
  static constexpr GaussClimber climber{&gather_avx2, &climb_avx2};
  return has_avx2() ? climber : plain_gauss_climber();
}

}  // namespace linescope

#else

namespace linescope {
const GaussClimber& fastest_gauss_climber() {
  return plain_gauss_climber();
}
}  // namespace linescope

#endif
