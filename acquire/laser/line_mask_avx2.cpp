// The first look, 32 pixels at a time on the interleaved bytes (line_mask_vector.hpp).
#include "acquire/laser/line_mask_vector.hpp"
#include "common/processor.hpp"

#if defined(__x86_64__)
#include <immintrin.h>

#include <bit>

namespace linescope {
namespace {

#define LINESCOPE_AVX2 __attribute__((target("avx2,bmi2")))
#define LINESCOPE_AVX2_INLINE __attribute__((target("avx2,bmi2"), always_inline)) inline

using mask_detail::lanes_of;
using mask_detail::Sides;

/// 255 in every third byte, from byte `Lead` on.
template <int Lead>
alignas(32) constexpr auto kLeadBytes = [] {
  std::array<std::uint8_t, 96> bytes{};
  for (std::size_t i = Lead; i < 96; i += 3) bytes[i] = 255;
  return bytes;
}();

LINESCOPE_AVX2_INLINE __m256i load(const std::uint8_t* p) {
  return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(p));
}

/// Colour excess, in the lanes of the leading channel.
template <unsigned On>
LINESCOPE_AVX2_INLINE __m256i excess(const std::uint8_t* q) {
  const __m256i b = load(q + mask_detail::from_lead(On, 0)), g = load(q + mask_detail::from_lead(On, 1)),
                r = load(q + mask_detail::from_lead(On, 2));
  if constexpr (On == 1) return _mm256_subs_epu8(b, _mm256_max_epu8(g, r));
  if constexpr (On == 2) return _mm256_subs_epu8(g, _mm256_max_epu8(b, r));
  if constexpr (On == 3) return _mm256_subs_epu8(_mm256_min_epu8(b, g), r);
  if constexpr (On == 4) return _mm256_subs_epu8(r, _mm256_max_epu8(b, g));
  if constexpr (On == 5) return _mm256_subs_epu8(_mm256_min_epu8(b, r), g);
  if constexpr (On == 6) return _mm256_subs_epu8(_mm256_min_epu8(g, r), b);
  return _mm256_min_epu8(b, _mm256_min_epu8(g, r));
}

struct Thresholds {
  __m256i colour, ridge;  ///< less one: a lane passes when it is greater
};

/// Nonzero lanes, among those wanted, where the 32 bytes at q pass one of the tests.
template <unsigned On, bool Ridge>
LINESCOPE_AVX2_INLINE __m256i passes(const std::uint8_t* q, __m256i lanes, const Sides& s,
                                     const Thresholds& t) {
  __m256i found = _mm256_subs_epu8(excess<On>(q), t.colour);
  if constexpr (Ridge) {
    const __m256i rise = _mm256_subs_epu8(load(q), _mm256_max_epu8(load(q + s.before), load(q + s.after)));
    found = _mm256_or_si256(found, _mm256_subs_epu8(rise, t.ridge));
  }
  return _mm256_and_si256(found, lanes);
}

LINESCOPE_AVX2_INLINE std::uint32_t pixel_bits(__m256i found, std::uint32_t lanes) {
  const __m256i zero = _mm256_cmpeq_epi8(found, _mm256_setzero_si256());
  return _pext_u32(~static_cast<std::uint32_t>(_mm256_movemask_epi8(zero)), lanes);
}

struct MarkAvx2 {
  template <unsigned On, bool Ridge>
  LINESCOPE_AVX2 static int mark(std::span<const mask_detail::MarkedRow> rows, const MaskRule& rule,
                                 int groups) {
    constexpr int kLead = mask_detail::lead_of(On);
    constexpr std::uint32_t kLanes0 = lanes_of<std::uint32_t>(kLead, 0),
                            kLanes1 = lanes_of<std::uint32_t>(kLead, 32),
                            kLanes2 = lanes_of<std::uint32_t>(kLead, 64);
    constexpr int kFirst1 = std::popcount(kLanes0), kFirst2 = kFirst1 + std::popcount(kLanes1);
    const Thresholds t{_mm256_set1_epi8(static_cast<char>(rule.colour_threshold - 1)),
                       _mm256_set1_epi8(static_cast<char>(rule.ridge_threshold - 1))};
    const __m256i lead0 = load(kLeadBytes<kLead>.data()), lead1 = load(kLeadBytes<kLead>.data() + 32),
                  lead2 = load(kLeadBytes<kLead>.data() + 64);
    for (int group = 0; group < groups; ++group) {
      for (const mask_detail::MarkedRow& row : rows) {
        const std::uint8_t* const q = row.pixels + group * mask_detail::kGroupBytes;
        for (int line = 0; line < 2; ++line)
          _mm_prefetch(reinterpret_cast<const char*>(q + row.ahead + 64 * line), _MM_HINT_T0);
        const __m256i f0 = passes<On, Ridge>(q, lead0, row.sides, t),
                      f1 = passes<On, Ridge>(q + 32, lead1, row.sides, t),
                      f2 = passes<On, Ridge>(q + 64, lead2, row.sides, t);
        const __m256i any = _mm256_or_si256(f0, _mm256_or_si256(f1, f2));
        std::uint32_t pixels = 0;
        if (!_mm256_testz_si256(any, any))
          pixels = pixel_bits(f0, kLanes0) | pixel_bits(f1, kLanes1) << kFirst1 |
                   pixel_bits(f2, kLanes2) << kFirst2;
        row.words[group] = pixels;
      }
    }
    return groups;
  }
};

}  // namespace

Marker mask_detail::avx2_marker(const MaskRule& rule) {
  return has_avx2_and_bits() ? marker_of<MarkAvx2>(rule) : nullptr;
}

}  // namespace linescope

#else

namespace linescope {
Marker mask_detail::avx2_marker(const MaskRule&) {
  return nullptr;
}
}  // namespace linescope

#endif
