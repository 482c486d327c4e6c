// RunFinder::take_columns with vectors of 32 columns.
#include "acquire/laser/run_finder.hpp"

#if defined(__x86_64__)
#include <immintrin.h>

#include <bit>

namespace linescope {

#define LINESCOPE_AVX512 __attribute__((target("avx512f,avx512bw,popcnt")))

// First where something changes, without a branch on it: specks make that a matter of chance.
LINESCOPE_AVX512 std::size_t RunFinder::list_changes(const std::uint32_t* words, int count, int height) {
  constexpr int kBlock = 16;  // words, compared at once
  const int all = count * height;
  changes_.resize(static_cast<std::size_t>(all) + kBlock);
  std::uint32_t* next = changes_.data();
  __m512i place = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  for (int at = 0; at < all; at += kBlock) {
    const auto lanes = static_cast<__mmask16>(all - at >= kBlock ? 0xFFFF : (1 << (all - at)) - 1);
    const std::uint32_t* const now = words + at;
    const __mmask16 changed = _mm512_cmpneq_epi32_mask(_mm512_maskz_loadu_epi32(lanes, now),
                                                       _mm512_maskz_loadu_epi32(lanes, now - count));
    _mm512_storeu_si512(next, _mm512_maskz_compress_epi32(changed, place));
    next += std::popcount(static_cast<unsigned>(changed));
    place = _mm512_add_epi32(place, _mm512_set1_epi32(kBlock));
  }
  return static_cast<std::size_t>(next - changes_.data());
}

LINESCOPE_AVX512 void RunFinder::take_columns_avx512(const std::uint32_t* words, int count, int height) {
  const auto narrow = [](int v) { return static_cast<std::int16_t>(v); };
  const __m512i none = _mm512_set1_epi16(kNone);
  const std::size_t changes = list_changes(words, count, height);
  // Exact for the 2^23 words of the largest picture.
  const std::uint64_t inverse = (std::uint64_t{1} << 40) / static_cast<std::uint64_t>(count) + 1;
  for (std::size_t i = 0; i < changes; ++i) {
    const std::uint32_t at = changes_[i];
    const auto y = static_cast<int>(at * inverse >> 40);
    const int x = (static_cast<int>(at) - y * count) * kMaskGroup;
    const std::uint32_t* const now = words + at;
    const __mmask32 ends = now[-count] & ~now[0], begins = now[0] & ~now[-count];
    std::int16_t* const first = open_first_.data() + x;
    std::int16_t* const last = open_last_.data() + x;
    const __m512i lasts = _mm512_loadu_si512(last);
    const __mmask32 fresh =
        _mm512_mask_cmplt_epi16_mask(begins, lasts, _mm512_set1_epi16(narrow(y - gap_ - 1)));
    for (std::uint32_t closing = _mm512_mask_cmpneq_epi16_mask(fresh, lasts, none); closing != 0;
         closing &= closing - 1) {
      const int column = std::countr_zero(closing);
      close(x + column, {first[column], last[column]});
    }
    _mm512_mask_storeu_epi16(last, ends, _mm512_set1_epi16(narrow(y - 1)));
    _mm512_mask_storeu_epi16(first, fresh, _mm512_set1_epi16(narrow(y)));
  }
}

}  // namespace linescope

#else

namespace linescope {
std::size_t RunFinder::list_changes(const std::uint32_t*, int, int) {
  return 0;
}
void RunFinder::take_columns_avx512(const std::uint32_t*, int, int) {}
}  // namespace linescope

#endif
