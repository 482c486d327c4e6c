// RunFinder::take_columns with vectors of 32 columns.
#include "acquire/laser/run_finder.hpp"

#if defined(__x86_64__)
#include <immintrin.h>

#include <bit>

namespace linescope {

#define LINESCOPE_AVX512 __attribute__((target("avx512f,avx512bw")))

bool RunFinder::knows_avx512() {
  return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw");
}

LINESCOPE_AVX512 void RunFinder::take_columns_avx512(int y, const std::uint32_t* words, int count) {
  constexpr int kBlock = 16;  // words, compared at once
  const auto short_of = [](int v) { return static_cast<std::int16_t>(v); };
  const __m512i row = _mm512_set1_epi16(short_of(y)), above = _mm512_set1_epi16(short_of(y - 1)),
                recent = _mm512_set1_epi16(short_of(y - gap_ - 1)), none = _mm512_set1_epi16(kNone);
  for (int block = 0; block < count; block += kBlock) {
    const int n = count - block;
    const auto lanes = static_cast<__mmask16>(n >= kBlock ? 0xFFFF : (1 << n) - 1);
    const std::uint32_t* const now = words + block;
    std::uint32_t changed = _mm512_cmpneq_epi32_mask(_mm512_maskz_loadu_epi32(lanes, now),
                                                     _mm512_maskz_loadu_epi32(lanes, now - count));
    for (; changed != 0; changed &= changed - 1) {
      const int w = std::countr_zero(changed), x = (block + w) * kMaskGroup;
      const __mmask32 ends = now[w - count] & ~now[w], begins = now[w] & ~now[w - count];
      std::int16_t* const first = open_first_.data() + x;
      std::int16_t* const last = open_last_.data() + x;
      const __m512i lasts = _mm512_loadu_si512(last);
      const __mmask32 fresh = _mm512_mask_cmplt_epi16_mask(begins, lasts, recent);
      for (std::uint32_t closing = _mm512_mask_cmpneq_epi16_mask(fresh, lasts, none); closing != 0;
           closing &= closing - 1) {
        const int i = std::countr_zero(closing);
        close(x + i, {first[i], last[i]});
      }
      _mm512_mask_storeu_epi16(last, ends, above);
      _mm512_mask_storeu_epi16(first, fresh, row);
    }
  }
}

}  // namespace linescope

#else

namespace linescope {
bool RunFinder::knows_avx512() {
  return false;
}
void RunFinder::take_columns_avx512(int, const std::uint32_t*, int) {}
}  // namespace linescope

#endif
