#include "viewer/surface/point_tile.hpp"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace linescope {
namespace {

#if defined(__x86_64__)
__attribute__((target("avx2"))) inline int index_of(__m128i cell, __m128i strides) {
  const __m128i parts = _mm_madd_epi16(cell, strides);
  const __m128i pairs = _mm_add_epi32(parts, _mm_shuffle_epi32(parts, 0b01001110));
  return _mm_cvtsi128_si32(_mm_add_epi32(pairs, _mm_shuffle_epi32(pairs, 0b10110001)));
}

// All factors are below 2^15 and not negative, so the 16-bit multiply-and-add, with the upper halves zero, is
// exact.
__attribute__((target("avx2"))) void add_moments_avx2(std::span<const PlacedPoint> points, const TileBox& box,
                                                      MomentSums* tile) {
  const __m128i base =
      _mm_set_epi32(0, box.low.z << kStepBits, box.low.y << kStepBits, box.low.x << kStepBits);
  const __m128i strides = _mm_set_epi32(0, box.nx() * box.ny(), box.nx(), 1);
  const __m128i mask = _mm_set_epi32(0, kSteps - 1, kSteps - 1, kSteps - 1), one = _mm_set_epi32(1, 0, 0, 0);
  for (const PlacedPoint& point : points) {
    const __m128i all = _mm_load_si128(reinterpret_cast<const __m128i*>(&point));
    const __m128i weights = _mm_shuffle_epi32(all, 0b11111111);
    const __m128i usable = _mm_cmpgt_epi32(weights, _mm_setzero_si128());
    const __m128i steps = _mm_and_si128(_mm_sub_epi32(all, base), usable);
    const __m128i cell = _mm_srli_epi32(steps, kStepBits);                                       // 4th: 0
    const __m128i place = _mm_or_si128(_mm_and_si128(steps, mask), _mm_and_si128(one, usable));  // x y z 1
    const __m128i weighted = _mm_madd_epi16(place, weights);                                     // wx wy wz w
    const __m128i counted = _mm_blend_epi32(weighted, place, 0b1000);                            // wx wy wz 1
    const __m128i turned = _mm_shuffle_epi32(place, 0b11001001);                                 // y z x 1
    auto* sums = reinterpret_cast<__m256i*>(tile + index_of(cell, strides));
    const __m256i squares = _mm256_cvtepu32_epi64(_mm_madd_epi16(counted, place));
    const __m256i products = _mm256_cvtepu32_epi64(_mm_madd_epi16(counted, turned));
    _mm256_store_si256(sums, _mm256_add_epi64(_mm256_load_si256(sums), _mm256_cvtepu32_epi64(weighted)));
    _mm256_store_si256(sums + 1, _mm256_add_epi64(_mm256_load_si256(sums + 1), squares));
    _mm256_store_si256(sums + 2, _mm256_add_epi64(_mm256_load_si256(sums + 2), products));
  }
}

bool has_avx2() {
  static const bool has = __builtin_cpu_supports("avx2") != 0;
  return has;
}
#endif

int tile_index(const PlacedPoint& p, std::int32_t shift, const TileBox& box) {
  const int x = ((p.x + shift) >> kStepBits) - box.low.x, y = ((p.y + shift) >> kStepBits) - box.low.y;
  const int z = ((p.z + shift) >> kStepBits) - box.low.z;
  return x + box.nx() * (y + box.ny() * z);
}

}  // namespace

TileBox box_of(const PlacedBounds& bounds, std::int32_t shift) {
  const auto place = [shift](const std::array<std::int32_t, 4>& at) {
    return GridIndex{(at[0] + shift) >> kStepBits, (at[1] + shift) >> kStepBits,
                     (at[2] + shift) >> kStepBits};
  };
  return {place(bounds.low), place(bounds.high)};
}

void add_moments_portable(std::span<const PlacedPoint> points, const TileBox& box, MomentSums* tile) {
  for (const PlacedPoint& point : points) {
    if (point.weight == 0) continue;
    MomentSums& sums = tile[tile_index(point, 0, box)];
    const std::array<std::int32_t, 4> place{point.x & (kSteps - 1), point.y & (kSteps - 1),
                                            point.z & (kSteps - 1), 1};
    const std::array<std::int32_t, 4> turned{place[1], place[2], place[0], 1};
    for (std::size_t i = 0; i < 4; ++i) {
      const std::int32_t weighted = point.weight * place[i];
      const std::int32_t counted = i == 3 ? 1 : weighted;
      sums.first[i] += weighted;
      sums.squares[i] += counted * place[i];
      sums.products[i] += counted * turned[i];
    }
  }
}

void add_moments(std::span<const PlacedPoint> points, const TileBox& box, MomentSums* tile) {
#if defined(__x86_64__)
  if (has_avx2()) return add_moments_avx2(points, box, tile);
#endif
  add_moments_portable(points, box, tile);
}

void count_points(std::span<const PlacedPoint> points, std::int32_t shift, const TileBox& box,
                  std::uint32_t* tile) {
  for (const PlacedPoint& point : points) {
    const int index = point.weight == 0 ? 0 : tile_index(point, shift, box);
    tile[index] += point.weight == 0 ? 0 : 1;
  }
}

}  // namespace linescope
