// The first look, 64 pixels at a time: line_mask_avx2.cpp with vectors twice as long and comparisons that
// give bits.
#include "acquire/laser/line_mask_vector.hpp"
#include "common/processor.hpp"

#if defined(__x86_64__)
#include <immintrin.h>

#include <bit>
#include <cstring>

namespace linescope {
namespace {

#define LINESCOPE_AVX512 __attribute__((target("avx512f,avx512bw,bmi2")))
#define LINESCOPE_AVX512_INLINE __attribute__((target("avx512f,avx512bw,bmi2"), always_inline)) inline

using mask_detail::lanes_of;
using mask_detail::Sides;

LINESCOPE_AVX512_INLINE __m512i load(const std::uint8_t* p) {
  return _mm512_loadu_si512(p);
}

/// Colour excess, in the lanes of the leading channel.
template <unsigned On>
LINESCOPE_AVX512_INLINE __m512i excess(const std::uint8_t* q) {
  const __m512i b = load(q + mask_detail::from_lead(On, 0)), g = load(q + mask_detail::from_lead(On, 1)),
                r = load(q + mask_detail::from_lead(On, 2));
  if constexpr (On == 1) return _mm512_subs_epu8(b, _mm512_max_epu8(g, r));
  if constexpr (On == 2) return _mm512_subs_epu8(g, _mm512_max_epu8(b, r));
  if constexpr (On == 3) return _mm512_subs_epu8(_mm512_min_epu8(b, g), r);
  if constexpr (On == 4) return _mm512_subs_epu8(r, _mm512_max_epu8(b, g));
  if constexpr (On == 5) return _mm512_subs_epu8(_mm512_min_epu8(b, r), g);
  if constexpr (On == 6) return _mm512_subs_epu8(_mm512_min_epu8(g, r), b);
  return _mm512_min_epu8(b, _mm512_min_epu8(g, r));
}

struct Thresholds {
  __m512i colour, ridge;  ///< less one: a lane passes when it is greater
};

/// Bits of the lanes, among those wanted, where the 64 bytes at q pass one of the tests.
template <unsigned On, bool Ridge>
LINESCOPE_AVX512_INLINE std::uint64_t passes(const std::uint8_t* q, std::uint64_t lanes, const Sides& s,
                                             const Thresholds& t) {
  std::uint64_t bits = _mm512_mask_cmpgt_epu8_mask(lanes, excess<On>(q), t.colour);
  if constexpr (Ridge) {
    const __m512i rise = _mm512_subs_epu8(load(q), _mm512_max_epu8(load(q + s.before), load(q + s.after)));
    bits |= _mm512_mask_cmpgt_epu8_mask(lanes, rise, t.ridge);
  }
  return bits;
}

struct MarkAvx512 {
  static constexpr int kGroups = 2;

  template <unsigned On, bool Ridge>
  LINESCOPE_AVX512 static int mark(std::span<const mask_detail::MarkedRow> rows, const MaskRule& rule,
                                   int groups) {
    constexpr int kLead = mask_detail::lead_of(On);
    constexpr std::uint64_t kLanes0 = lanes_of<std::uint64_t>(kLead, 0),
                            kLanes1 = lanes_of<std::uint64_t>(kLead, 64),
                            kLanes2 = lanes_of<std::uint64_t>(kLead, 128);
    constexpr int kFirst1 = std::popcount(kLanes0), kFirst2 = kFirst1 + std::popcount(kLanes1);
    const Thresholds t{_mm512_set1_epi8(static_cast<char>(rule.colour_threshold - 1)),
                       _mm512_set1_epi8(static_cast<char>(rule.ridge_threshold - 1))};
    int group = 0;
    for (; group + kGroups <= groups; group += kGroups) {
      for (const mask_detail::MarkedRow& row : rows) {
        const std::uint8_t* const q = row.pixels + group * mask_detail::kGroupBytes;
        for (int line = 0; line < 3; ++line)
          _mm_prefetch(reinterpret_cast<const char*>(q + row.ahead + 64 * line), _MM_HINT_T0);
        const std::uint64_t b0 = passes<On, Ridge>(q, kLanes0, row.sides, t),
                            b1 = passes<On, Ridge>(q + 64, kLanes1, row.sides, t),
                            b2 = passes<On, Ridge>(q + 128, kLanes2, row.sides, t);
        std::uint64_t pixels = 0;
        if ((b0 | b1 | b2) != 0)
          pixels =
              _pext_u64(b0, kLanes0) | _pext_u64(b1, kLanes1) << kFirst1 | _pext_u64(b2, kLanes2) << kFirst2;
        std::memcpy(row.words + group, &pixels, sizeof(pixels));
      }
    }
    return group;
  }
};

}  // namespace

Marker mask_detail::avx512_marker(const MaskRule& rule) {
  return has_avx512() ? marker_of<MarkAvx512>(rule) : nullptr;
}

}  // namespace linescope

#else

namespace linescope {
Marker mask_detail::avx512_marker(const MaskRule&) {
  return nullptr;
}
}  // namespace linescope

#endif
