// The tile sixteen points at a time: the same numbers as the plain form.
#include "viewer/surface/point_tile_detail.hpp"

#if defined(__x86_64__)
#include <immintrin.h>

#include <bit>

namespace linescope {
namespace {

using tile_detail::TileFrame;

#define LINESCOPE_AVX2 __attribute__((target("avx2"), always_inline)) inline

LINESCOPE_AVX2 __m256i load(const std::int32_t* values) {
  return _mm256_load_si256(reinterpret_cast<const __m256i*>(values));
}

LINESCOPE_AVX2 __m256i load(const std::array<std::int16_t, 16>& values) {
  return _mm256_load_si256(reinterpret_cast<const __m256i*>(values.data()));
}

template <class T, std::size_t kCount>
LINESCOPE_AVX2 void store(std::array<T, kCount>& to, __m256i values) {
  static_assert(sizeof(to) == sizeof(values));
  _mm256_store_si256(reinterpret_cast<__m256i*>(to.data()), values);
}

// Two registers of eight to one of sixteen short numbers (in the same, mixed order for every coordinate).
LINESCOPE_AVX2 __m256i packed(__m256i low, __m256i high) {
  return _mm256_packs_epi32(low, high);
}

struct Coordinate16 {
  __m256i cell, within;  // place along the axis, steps within the cube
};

LINESCOPE_AVX2 Coordinate16 split(const std::int32_t* values, std::int32_t origin) {
  const __m256i base = _mm256_set1_epi32(origin), mask = _mm256_set1_epi32(kSteps - 1);
  const __m256i low = _mm256_sub_epi32(load(values), base), high = _mm256_sub_epi32(load(values + 8), base);
  return {packed(_mm256_srai_epi32(low, kStepBits), _mm256_srai_epi32(high, kStepBits)),
          packed(_mm256_and_si256(low, mask), _mm256_and_si256(high, mask))};
}

LINESCOPE_AVX2 __m256i weights_of(const PlacedBlock& block) {
  return packed(load(block.weight.data()), load(block.weight.data() + 8));
}

// The places of sixteen points; those of refused points cannot be (all ones).
LINESCOPE_AVX2 __m256i places_of(const Coordinate16& x, const Coordinate16& y, const Coordinate16& z,
                                 __m256i weight, const TileFrame& frame) {
  const __m256i rows = _mm256_mullo_epi16(y.cell, _mm256_set1_epi16(static_cast<short>(frame.stride[1])));
  const __m256i layers = _mm256_mullo_epi16(z.cell, _mm256_set1_epi16(static_cast<short>(frame.stride[2])));
  const __m256i place = _mm256_add_epi16(x.cell, _mm256_add_epi16(rows, layers));
  return _mm256_or_si256(place, _mm256_cmpeq_epi16(weight, _mm256_setzero_si256()));
}

// The lanes of sixteen points, two bits each, that are not refused.
LINESCOPE_AVX2 unsigned usable_lanes(__m256i places) {
  const __m256i refused = _mm256_cmpeq_epi16(places, _mm256_set1_epi16(-1));
  return ~static_cast<unsigned>(_mm256_movemask_epi8(refused));
}

LINESCOPE_AVX2 __m256i lanes_at(__m256i places, std::size_t place) {
  return _mm256_cmpeq_epi16(places, _mm256_set1_epi16(static_cast<short>(place)));
}

// The place of the first lane in a mask.
LINESCOPE_AVX2 std::size_t first_of(const std::array<std::int16_t, 16>& places, unsigned lanes) {
  return static_cast<std::uint16_t>(places[static_cast<std::size_t>(std::countr_zero(lanes)) >> 1]);
}

// A point and its weight in one number: ones in the lower bits, which count to kBatch blocks, weights above.
constexpr int kCountBits = 10;
static_assert(MomentTile::kBatch * kPlacedPoints < 1 << kCountBits);
static_assert(kMaxPointWeight << kCountBits < 1 << 15);

// Within the loop steps are counted from the middle of a cube: twice as many squares fit into 32 bits. The
// factors are within 2^14.
constexpr std::int32_t kMiddle = kSteps / 2;
static_assert(MomentTile::kBatch * 2 * kMaxPointWeight < (std::uint64_t{1} << 31) / (kMiddle * kMiddle));

// Sixteen points, weighted once and then masked place by place.
LINESCOPE_AVX2 void prepare(const PlacedBlock& block, const TileFrame& frame, PreparedBlock& to) {
  const Coordinate16 x = split(block.x.data(), frame.origin[0]), y = split(block.y.data(), frame.origin[1]),
                     z = split(block.z.data(), frame.origin[2]);
  const __m256i weight = weights_of(block), middle = _mm256_set1_epi16(kMiddle);
  const __m256i from_middle[3] = {_mm256_sub_epi16(x.within, middle), _mm256_sub_epi16(y.within, middle),
                                  _mm256_sub_epi16(z.within, middle)};
  for (std::size_t i = 0; i < 3; ++i) {
    store(to.at[i], from_middle[i]);
    store(to.weighted[i], _mm256_mullo_epi16(from_middle[i], weight));
  }
  store(to.counted, _mm256_or_si256(_mm256_slli_epi16(weight, kCountBits), _mm256_set1_epi16(1)));
  store(to.place, places_of(x, y, z, weight, frame));
}

LINESCOPE_AVX2 __m256i plus_products(__m256i sum, __m256i a, __m256i b) {
  return _mm256_add_epi32(sum, _mm256_madd_epi16(a, b));
}

// Sums of one cube: x y z and the count, xx yy zz, xy yz zx, in eight lanes each.
struct LaneSums {
  __m256i first[4], squares[3], products[3];
};

LINESCOPE_AVX2 void add_masked(const PreparedBlock& block, __m256i lanes, LaneSums& sums) {
  const __m256i one = _mm256_set1_epi16(1);
  const __m256i at[3] = {load(block.at[0]), load(block.at[1]), load(block.at[2])};
  for (std::size_t i = 0; i < 3; ++i) {
    const __m256i weighted = _mm256_and_si256(load(block.weighted[i]), lanes);
    sums.first[i] = plus_products(sums.first[i], weighted, one);
    sums.squares[i] = plus_products(sums.squares[i], weighted, at[i]);
    sums.products[i] = plus_products(sums.products[i], weighted, at[(i + 1) % 3]);
  }
  sums.first[3] = plus_products(sums.first[3], _mm256_and_si256(load(block.counted), lanes), one);
}

LINESCOPE_AVX2 __m256i sum_of(__m256i lanes) {  // four parts of 64 bits
  return _mm256_add_epi64(_mm256_cvtepi32_epi64(_mm256_castsi256_si128(lanes)),
                          _mm256_cvtepi32_epi64(_mm256_extracti128_si256(lanes, 1)));
}

// a's, b's, c's and d's sums.
LINESCOPE_AVX2 __m256i across(__m256i a, __m256i b, __m256i c, __m256i d) {
  const __m256i ab = _mm256_add_epi64(_mm256_unpacklo_epi64(a, b), _mm256_unpackhi_epi64(a, b));
  const __m256i cd = _mm256_add_epi64(_mm256_unpacklo_epi64(c, d), _mm256_unpackhi_epi64(c, d));
  return _mm256_add_epi64(_mm256_permute2x128_si256(ab, cd, 0x20), _mm256_permute2x128_si256(ab, cd, 0x31));
}

// From the middle of the cube to its lowest corner: (x + m)(y + m) = xy + m x + m y + m m.
void move_to_corner(MomentSums& sums) {
  const std::int64_t m = kMiddle, weight = sums.first[3];
  const std::array<std::int64_t, 3> at{sums.first[0], sums.first[1], sums.first[2]};
  for (std::size_t i = 0; i < 3; ++i) {
    sums.first[i] += m * weight;
    sums.squares[i] += m * (2 * at[i] + m * weight);
    sums.products[i] += m * (at[i] + at[(i + 1) % 3] + m * weight);
  }
}

LINESCOPE_AVX2 void narrow(const LaneSums& lanes, MomentSums& sums) {
  const __m256i pairs = _mm256_hadd_epi32(_mm256_hadd_epi32(lanes.first[0], lanes.first[1]),
                                          _mm256_hadd_epi32(lanes.first[2], lanes.first[3]));
  store(sums.first, _mm256_cvtepi32_epi64(
                        _mm_add_epi32(_mm256_castsi256_si128(pairs), _mm256_extracti128_si256(pairs, 1))));
  const std::int64_t counted = sums.first[3], count = counted & ((1 << kCountBits) - 1);
  sums.first[3] = counted >> kCountBits;
  const __m256i none = _mm256_setzero_si256();
  const auto& [xx, yy, zz] = lanes.squares;
  store(sums.squares, across(sum_of(xx), sum_of(yy), sum_of(zz), none));
  const auto& [xy, yz, zx] = lanes.products;
  store(sums.products, across(sum_of(xy), sum_of(yz), sum_of(zx), none));
  sums.squares[3] = sums.products[3] = count;
  move_to_corner(sums);
}

}  // namespace

__attribute__((target("avx2,bmi,popcnt"))) void tile_detail::count_points_avx2(
    std::span<const PlacedBlock> blocks, std::int32_t shift, const TileBox& box, std::uint32_t* tile) {
  const TileFrame frame(box, shift);
  for (const PlacedBlock& block : blocks) {
    const Coordinate16 x = split(block.x.data(), frame.origin[0]), y = split(block.y.data(), frame.origin[1]),
                       z = split(block.z.data(), frame.origin[2]);
    const __m256i places = places_of(x, y, z, weights_of(block), frame);
    alignas(32) std::array<std::int16_t, 16> each;
    store(each, places);
    for (unsigned pending = usable_lanes(places); pending != 0;) {
      const std::size_t place = first_of(each, pending);
      const auto taken = static_cast<unsigned>(_mm256_movemask_epi8(lanes_at(places, place)));
      pending &= ~taken;
      tile[place] += static_cast<std::uint32_t>(std::popcount(taken)) / 2;
    }
  }
}

// The places of a block's points, each once; without a branch where that can be helped, because neither how
// many there are nor whether one is new can be guessed. Most blocks have one or two.
__attribute__((target("avx2,bmi"))) void MomentTile::list_places(std::span<const PlacedBlock> batch,
                                                                 const TileBox& box) {
  const TileFrame frame(box, 0);
  std::uint16_t* const last = last_.data();
  std::uint16_t* const touched = touched_.data();
  Mention* const mentions = mentions_.data();
  unsigned count = 0, places = 0;
  const auto mention = [&](std::size_t place, std::size_t block, bool there) {
    mentions[count] = {static_cast<std::uint16_t>(block), last[place]};
    touched[places] = static_cast<std::uint16_t>(place);
    places += there && last[place] == kNobody ? 1 : 0;
    last[place] = there ? static_cast<std::uint16_t>(count) : last[place];
    count += there ? 1 : 0;
  };
  for (std::size_t i = 0; i < batch.size(); ++i) {
    PreparedBlock& block = prepared_[i];
    prepare(batch[i], frame, block);
    const __m256i all = load(block.place);
    for (unsigned pending = usable_lanes(all); pending != 0;) {
      const std::size_t first = first_of(block.place, pending);
      pending &= ~static_cast<unsigned>(_mm256_movemask_epi8(lanes_at(all, first)));
      mention(first, i, true);
      const std::size_t second = pending == 0 ? first : first_of(block.place, pending);
      mention(second, i, pending != 0);
      pending &= ~static_cast<unsigned>(_mm256_movemask_epi8(lanes_at(all, second)));
    }
  }
  cubes_.resize(places);
}

__attribute__((target("avx2"))) void MomentTile::add_up_places() {
  for (std::size_t i = 0; i < cubes_.size(); ++i) {
    const std::size_t place = touched_[i];
    LaneSums sums;
    for (__m256i* sum :
         {&sums.first[0], &sums.first[1], &sums.first[2], &sums.first[3], &sums.squares[0], &sums.squares[1],
          &sums.squares[2], &sums.products[0], &sums.products[1], &sums.products[2]})
      *sum = _mm256_setzero_si256();
    for (unsigned at = last_[place]; at != kNobody; at = mentions_[at].before) {
      const PreparedBlock& block = prepared_[mentions_[at].block];
      add_masked(block, lanes_at(load(block.place), place), sums);
    }
    cubes_[i].place = static_cast<int>(place);
    narrow(sums, cubes_[i].sums);
    last_[place] = kNobody;
  }
}

}  // namespace linescope

#endif
