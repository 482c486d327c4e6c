// The first look, 32 pixels at a time on the interleaved bytes. Channels are never separated: blue, green and
// red of a pixel are three loads one byte apart, and only every third lane of the result means something.
#include "acquire/laser/line_mask.hpp"
#include "acquire/laser/line_mask_detail.hpp"

#if defined(__x86_64__)
#include <immintrin.h>

#include <array>

namespace linescope {
namespace {

#define LINESCOPE_AVX2 __attribute__((target("avx2,bmi2")))
#define LINESCOPE_AVX2_INLINE __attribute__((target("avx2,bmi2"), always_inline)) inline

/// Which lanes of the three vectors of a group hold the first byte of a pixel; 32 bytes a vector.
constexpr auto kPixelLanes = [] {
  std::array<std::uint8_t, 96> lanes{};
  for (std::size_t i = 0; i < 96; i += 3) lanes[i] = 255;
  return lanes;
}();
constexpr std::array<std::uint32_t, 3> kPixelBits{0x49249249U, 0x92492492U, 0x24924924U};

LINESCOPE_AVX2_INLINE __m256i load(const std::uint8_t* p) {
  return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(p));
}

template <unsigned On>
LINESCOPE_AVX2_INLINE __m256i excess(__m256i b, __m256i g, __m256i r) {
  if constexpr (On == 1) return _mm256_subs_epu8(b, _mm256_max_epu8(g, r));
  if constexpr (On == 2) return _mm256_subs_epu8(g, _mm256_max_epu8(b, r));
  if constexpr (On == 3) return _mm256_subs_epu8(_mm256_min_epu8(b, g), r);
  if constexpr (On == 4) return _mm256_subs_epu8(r, _mm256_max_epu8(b, g));
  if constexpr (On == 5) return _mm256_subs_epu8(_mm256_min_epu8(b, r), g);
  if constexpr (On == 6) return _mm256_subs_epu8(_mm256_min_epu8(g, r), b);
  return _mm256_min_epu8(b, _mm256_min_epu8(g, r));
}

/// Nonzero lanes where the 32 bytes at q pass one of the tests.
template <unsigned On, bool Ridge>
LINESCOPE_AVX2_INLINE __m256i passes(const std::uint8_t* q, int lead, const mask_detail::Sides& s,
                                     __m256i colour, __m256i ridge) {
  const __m256i b = load(q), g = load(q + 1), r = load(q + 2);
  const __m256i by_colour = _mm256_subs_epu8(excess<On>(b, g, r), colour);
  if constexpr (!Ridge) return by_colour;
  const __m256i around = _mm256_max_epu8(load(q + lead + s.before), load(q + lead + s.after));
  const __m256i light = lead == 0 ? b : lead == 1 ? g : r;
  return _mm256_or_si256(by_colour, _mm256_subs_epu8(_mm256_subs_epu8(light, around), ridge));
}

LINESCOPE_AVX2_INLINE std::uint32_t pixel_bits(__m256i lanes, std::size_t vector) {
  const auto zero =
      static_cast<std::uint32_t>(_mm256_movemask_epi8(_mm256_cmpeq_epi8(lanes, _mm256_setzero_si256())));
  return _pext_u32(~zero, kPixelBits[vector]);
}

template <unsigned On, bool Ridge>
LINESCOPE_AVX2_INLINE std::uint32_t mark_32(const std::uint8_t* q, int lead, const mask_detail::Sides& s,
                                            __m256i colour, __m256i ridge) {
  const __m256i l0 = _mm256_and_si256(passes<On, Ridge>(q, lead, s, colour, ridge), load(kPixelLanes.data()));
  const __m256i l1 =
      _mm256_and_si256(passes<On, Ridge>(q + 32, lead, s, colour, ridge), load(kPixelLanes.data() + 32));
  const __m256i l2 =
      _mm256_and_si256(passes<On, Ridge>(q + 64, lead, s, colour, ridge), load(kPixelLanes.data() + 64));
  const __m256i any = _mm256_or_si256(l0, _mm256_or_si256(l1, l2));
  if (_mm256_testz_si256(any, any)) return 0;
  // The first pixel of each vector is byte 0, 1, 2 of it: 11, 11 and 10 pixels.
  return pixel_bits(l0, 0) | pixel_bits(l1, 1) << 11 | pixel_bits(l2, 2) << 22;
}

template <unsigned On, bool Ridge>
LINESCOPE_AVX2 void mark_row_avx2(const PictureView& p, const MaskRule& rule, int y, std::uint32_t* words) {
  const __m256i colour = _mm256_set1_epi8(static_cast<char>(rule.colour_threshold - 1));
  const __m256i ridge = _mm256_set1_epi8(static_cast<char>(rule.ridge_threshold - 1));
  const std::uint8_t* row = p.data + p.stride * y;
  // The last vector reads two bytes past its group: harmless except behind the picture's last row.
  const bool reaches_down = Ridge && rule.axis == ProfileAxis::column && y + rule.reach < p.height;
  const int deepest = reaches_down ? y + rule.reach : y;
  const int whole = p.width / kMaskGroup - (deepest >= p.height - 1 ? 1 : 0);
  mask_detail::Sides sides = mask_detail::sides_of_group(p, rule, y, 0);
  int group = 0;
  for (; group < whole; ++group) {
    const int x = group * kMaskGroup;
    if (Ridge && rule.axis == ProfileAxis::row) sides = mask_detail::sides_of_group(p, rule, y, x);
    words[group] = mark_32<On, Ridge>(row + 3 * x, rule.lead, sides, colour, ridge);
  }
  for (; group < mask_words(p.width); ++group)
    words[group] = mask_detail::mark_group(p, rule, y, group * kMaskGroup);
}

template <unsigned On>
RowMarker marker(bool ridge) {
  return ridge ? &mark_row_avx2<On, true> : &mark_row_avx2<On, false>;
}

}  // namespace

RowMarker fastest_row_marker(const PictureView& picture, const MaskRule& rule) {
  if (picture.channels != 3 || !__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("bmi2"))
    return &mark_row;
  switch (rule.on) {
    case 1:
      return marker<1>(rule.ridge());
    case 2:
      return marker<2>(rule.ridge());
    case 3:
      return marker<3>(rule.ridge());
    case 4:
      return marker<4>(rule.ridge());
    case 5:
      return marker<5>(rule.ridge());
    case 6:
      return marker<6>(rule.ridge());
    default:
      return marker<7>(rule.ridge());
  }
}

}  // namespace linescope

#else

namespace linescope {
RowMarker fastest_row_marker(const PictureView&, const MaskRule&) {
  return &mark_row;
}
}  // namespace linescope

#endif
