// Sums along eight runs at once: one gather brings the next pixel of each.
#include "acquire/laser/run_block.hpp"
#include "common/processor.hpp"

#if defined(__x86_64__)
#include <immintrin.h>

namespace linescope {
namespace {

#define LINESCOPE_AVX2 __attribute__((target("avx2")))
#define LINESCOPE_AVX2_INLINE __attribute__((target("avx2"), always_inline)) inline

LINESCOPE_AVX2_INLINE __m256i load(const LaneInts& v) {
  return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(v.data()));
}

LINESCOPE_AVX2_INLINE void store(LaneInts& v, __m256i x) {
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(v.data()), x);
}

LINESCOPE_AVX2_INLINE void store(LaneFloats& v, __m256 x) {
  _mm256_storeu_ps(v.data(), x);
}

/// Goes along the runs of a block, pixel by pixel.
struct Walk {
  const int* picture;
  __m256i at, step, left;

  LINESCOPE_AVX2_INLINE explicit Walk(const RunBlock& b)
      : picture(reinterpret_cast<const int*>(b.picture)),
        at(load(b.begin_at)),
        step(_mm256_set1_epi32(b.step)),
        left(load(b.length)) {}

  /// All ones in the lanes whose run has not ended.
  LINESCOPE_AVX2_INLINE __m256i inside() const { return _mm256_cmpgt_epi32(left, _mm256_setzero_si256()); }

  /// Four bytes per lane; 0 where the run has ended.
  LINESCOPE_AVX2_INLINE __m256i next(__m256i mask) {
    const __m256i pixel = _mm256_mask_i32gather_epi32(_mm256_setzero_si256(), picture, at, mask, 1);
    at = _mm256_add_epi32(at, step);
    left = _mm256_sub_epi32(left, _mm256_set1_epi32(1));
    return pixel;
  }
};

/// The channels within a pixel.
struct Channels {
  __m128i shift0, shift1, shift2;

  LINESCOPE_AVX2_INLINE explicit Channels(const RunBlock& b)
      : shift0(_mm_cvtsi32_si128(b.shift[0])),
        shift1(_mm_cvtsi32_si128(b.shift[1])),
        shift2(_mm_cvtsi32_si128(b.shift[2])) {}

  LINESCOPE_AVX2_INLINE static __m256i byte(__m256i pixel, __m128i shift) {
    return _mm256_and_si256(_mm256_srl_epi32(pixel, shift), _mm256_set1_epi32(255));
  }
  LINESCOPE_AVX2_INLINE __m256i lead(__m256i pixel) const { return byte(pixel, shift0); }
};

/// ColourExcess::of.
struct Excess {
  __m256i dark0, dark1, dark2;

  LINESCOPE_AVX2_INLINE explicit Excess(const ColourExcess& e)
      : dark0(_mm256_set1_epi32(e.dark_bits()[0])),
        dark1(_mm256_set1_epi32(e.dark_bits()[1])),
        dark2(_mm256_set1_epi32(e.dark_bits()[2])) {}

  LINESCOPE_AVX2_INLINE __m256i of(const Channels& c, __m256i pixel) const {
    const __m256i v0 = c.lead(pixel), v1 = Channels::byte(pixel, c.shift1),
                  v2 = Channels::byte(pixel, c.shift2);
    const __m256i lit = _mm256_min_epi32(
        _mm256_or_si256(v0, dark0), _mm256_min_epi32(_mm256_or_si256(v1, dark1), _mm256_or_si256(v2, dark2)));
    const __m256i dark =
        _mm256_max_epi32(_mm256_and_si256(v0, dark0),
                         _mm256_max_epi32(_mm256_and_si256(v1, dark1), _mm256_and_si256(v2, dark2)));
    return _mm256_sub_epi32(lit, dark);
  }
};

}  // namespace

bool block_sums_known() {
  return has_avx2();
}

LINESCOPE_AVX2 void run_means(const RunBlock& block, const ColourExcess& excess, MeanLevels levels,
                              RunMeanBlock& out) {
  Walk walk(block);
  const Channels channels(block);
  const Excess colour(excess);
  const __m256i below = _mm256_set1_epi32(levels.threshold - 1),
                unsaturated = _mm256_set1_epi32(levels.saturation - 1);
  __m256i sum = _mm256_setzero_si256(), sums = sum, saturated = sum, peak = _mm256_set1_epi32(1);
  for (int i = 0; i < block.longest; ++i) {
    const __m256i inside = walk.inside(), pixel = walk.next(inside), e = colour.of(channels, pixel);
    const __m256i weight = _mm256_and_si256(_mm256_and_si256(e, inside), _mm256_cmpgt_epi32(e, below));
    saturated = _mm256_sub_epi32(saturated, _mm256_cmpgt_epi32(channels.lead(pixel), unsaturated));
    sum = _mm256_add_epi32(sum, weight);
    sums = _mm256_add_epi32(sums, _mm256_and_si256(sum, inside));
    peak = _mm256_max_epi32(peak, weight);
  }
  const __m256 area = _mm256_cvtepi32_ps(_mm256_max_epi32(sum, _mm256_set1_epi32(1))),
               height = _mm256_cvtepi32_ps(peak);
  store(out.before_end, _mm256_div_ps(_mm256_cvtepi32_ps(sums), area));
  store(out.sigma, _mm256_div_ps(area, _mm256_mul_ps(height, _mm256_set1_ps(kGaussArea))));
  store(out.peak, height);
  store(out.saturated, _mm256_cvtepi32_ps(saturated));
}

LINESCOPE_AVX2 void light_sums(const RunBlock& block, const ColourExcess& excess, int background,
                               LightSumsBlock& out) {
  Walk walk(block);
  const Channels channels(block);
  const Excess colour(excess);
  const __m256i zero = _mm256_setzero_si256(), ground = _mm256_set1_epi32(background);
  __m256i sum = zero, moment = zero, top = zero, brightest = zero, index = zero;
  for (int i = 0; i < block.longest; ++i) {
    const __m256i inside = walk.inside(), pixel = walk.next(inside), value = channels.lead(pixel);
    const __m256i light = _mm256_and_si256(_mm256_max_epi32(zero, _mm256_sub_epi32(value, ground)), inside);
    brightest = _mm256_blendv_epi8(brightest, pixel, _mm256_cmpgt_epi32(value, top));
    top = _mm256_max_epi32(top, value);
    sum = _mm256_add_epi32(sum, light);
    moment = _mm256_add_epi32(moment, _mm256_mullo_epi32(light, index));
    index = _mm256_add_epi32(index, _mm256_set1_epi32(1));
  }
  store(out.sum, sum);
  store(out.moment, moment);
  store(out.top, top);
  store(out.excess, colour.of(channels, brightest));
}

}  // namespace linescope

#else

namespace linescope {
bool block_sums_known() {
  return false;
}
void run_means(const RunBlock&, const ColourExcess&, MeanLevels, RunMeanBlock&) {}
void light_sums(const RunBlock&, const ColourExcess&, int, LightSumsBlock&) {}
}  // namespace linescope

#endif
