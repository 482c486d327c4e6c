#include "viewer/surface/point_placement.hpp"

#include <algorithm>
#include <limits>

#include "common/processor.hpp"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace linescope {
namespace {

// Rounds weight_scale / sd^2 to 1 .. kMaxPointWeight; a deviation of 0 is unknown and counts as typical.
std::int32_t weight_of(float deviation, float scale) {
  if (deviation == 0) return kTypicalWeight;
  const float exact = scale / (deviation * deviation) + 0.5f;
  return static_cast<std::int32_t>(std::max(1.0f, std::min(exact, static_cast<float>(kMaxPointWeight))));
}

void place_point(const LinePlacement& placement, const SurfacePoint& point, std::size_t lane,
                 PlacedBlock& block) {
  if (!placement.admits(point)) return;
  const auto steps = [&](Eigen::Index axis) {
    const float from_origin = point.position[axis] - placement.origin[static_cast<std::size_t>(axis)];
    return static_cast<std::int32_t>(from_origin * placement.steps_per_mm);
  };
  block.x[lane] = steps(0);
  block.y[lane] = steps(1);
  block.z[lane] = steps(2);
  block.weight[lane] = weight_of(point.standard_deviation, placement.weight_scale);
}

PlacedBounds no_bounds() {
  constexpr std::int32_t most = std::numeric_limits<std::int32_t>::max();
  return {{most, most, most}, {}, 0};
}

void include(PlacedBounds& bounds, const PlacedBlock& block, std::size_t lane) {
  if (block.weight[lane] == 0) return;
  ++bounds.usable;
  const std::array<std::int32_t, 3> at{block.x[lane], block.y[lane], block.z[lane]};
  for (std::size_t i = 0; i < 3; ++i) {
    bounds.low[i] = std::min(bounds.low[i], at[i]);
    bounds.high[i] = std::max(bounds.high[i], at[i]);
  }
}

#if defined(__x86_64__)
#define LINESCOPE_AVX2 __attribute__((target("avx2"), always_inline)) inline

constexpr int kFields = sizeof(SurfacePoint) / sizeof(float);  // x y z intensity deviation
constexpr int kDeviation = 4;
static_assert(kFields == 5);

// Eight points are five registers of eight numbers. Field f of point k is number 5 k + f, so that no two
// points have it in the same lane (5 and 8 share no factor): blending the five registers collects all eight.
template <int kField>
constexpr int lanes_of(int reg) {
  int mask = 0;
  for (int k = 0; k < 8; ++k)
    if ((kFields * k + kField) / 8 == reg) mask |= 1 << (kFields * k + kField) % 8;
  return mask;
}

struct EightPoints {
  __m256 reg[kFields];
};

LINESCOPE_AVX2 EightPoints load_eight(const SurfacePoint* points) {
  const auto* numbers = reinterpret_cast<const float*>(points);
  EightPoints result;
  for (int i = 0; i < kFields; ++i) result.reg[i] = _mm256_loadu_ps(numbers + 8 * i);
  return result;
}

template <int kField>
LINESCOPE_AVX2 __m256 field_of(const EightPoints& points) {
  __m256 all = _mm256_blend_ps(points.reg[0], points.reg[1], lanes_of<kField>(1));
  all = _mm256_blend_ps(all, points.reg[2], lanes_of<kField>(2));
  all = _mm256_blend_ps(all, points.reg[3], lanes_of<kField>(3));
  all = _mm256_blend_ps(all, points.reg[4], lanes_of<kField>(4));
  const __m256i order =
      _mm256_setr_epi32(kField % 8, (kField + 5) % 8, (kField + 10) % 8, (kField + 15) % 8, (kField + 20) % 8,
                        (kField + 25) % 8, (kField + 30) % 8, (kField + 35) % 8);
  return _mm256_permutevar8x32_ps(all, order);
}

struct Placement8 {
  __m256 low[4], high[4], origin[3];
  __m256 scale, weight_scale;
};

LINESCOPE_AVX2 Placement8 spread(const LinePlacement& placement) {
  Placement8 result;
  for (std::size_t i = 0; i < 4; ++i) {
    result.low[i] = _mm256_set1_ps(placement.low[i]);
    result.high[i] = _mm256_set1_ps(placement.high[i]);
  }
  for (std::size_t i = 0; i < 3; ++i) result.origin[i] = _mm256_set1_ps(placement.origin[i]);
  result.scale = _mm256_set1_ps(placement.steps_per_mm);
  result.weight_scale = _mm256_set1_ps(placement.weight_scale);
  return result;
}

LINESCOPE_AVX2 __m256 within(__m256 values, __m256 low, __m256 high) {
  return _mm256_and_ps(_mm256_cmp_ps(values, low, _CMP_GE_OQ), _mm256_cmp_ps(values, high, _CMP_LE_OQ));
}

LINESCOPE_AVX2 __m256i weights_of(__m256 deviation, __m256 scale) {
  const __m256 unknown = _mm256_cmp_ps(deviation, _mm256_setzero_ps(), _CMP_EQ_OQ);
  const __m256 typical = _mm256_and_ps(unknown, _mm256_mul_ps(scale, _mm256_set1_ps(1.0f / kTypicalWeight)));
  const __m256 variance = _mm256_or_ps(_mm256_mul_ps(deviation, deviation), typical);  // one of them is 0
  const __m256 exact = _mm256_add_ps(_mm256_div_ps(scale, variance), _mm256_set1_ps(0.5f));
  return _mm256_cvttps_epi32(
      _mm256_max_ps(_mm256_min_ps(exact, _mm256_set1_ps(kMaxPointWeight)), _mm256_set1_ps(1)));
}

// Lowest and highest so far; refused lanes are all ones for the one and zero for the other.
struct Bounds8 {
  __m256i low[3], high[3], usable;
};

LINESCOPE_AVX2 void place_eight(const Placement8& placement, const SurfacePoint* points, std::size_t lane,
                                PlacedBlock& block, Bounds8& bounds) {
  const EightPoints eight = load_eight(points);
  const __m256 at[3] = {field_of<0>(eight), field_of<1>(eight), field_of<2>(eight)};
  const __m256 deviation = field_of<kDeviation>(eight);
  __m256 admitted = within(deviation, placement.low[3], placement.high[3]);
#pragma GCC unroll 3  // or bounds go through memory
  for (int i = 0; i < 3; ++i)
    admitted = _mm256_and_ps(admitted, within(at[i], placement.low[i], placement.high[i]));
  const __m256i usable = _mm256_castps_si256(admitted);
  const __m256i refused = _mm256_xor_si256(usable, _mm256_set1_epi32(-1));
  std::int32_t* const rows[3] = {block.x.data() + lane, block.y.data() + lane, block.z.data() + lane};
#pragma GCC unroll 3
  for (int i = 0; i < 3; ++i) {
    const __m256i steps = _mm256_and_si256(
        _mm256_cvttps_epi32(_mm256_mul_ps(_mm256_sub_ps(at[i], placement.origin[i]), placement.scale)),
        usable);
    _mm256_store_si256(reinterpret_cast<__m256i*>(rows[i]), steps);
    bounds.low[i] = _mm256_min_epu32(bounds.low[i], _mm256_or_si256(steps, refused));
    bounds.high[i] = _mm256_max_epu32(bounds.high[i], steps);
  }
  _mm256_store_si256(reinterpret_cast<__m256i*>(block.weight.data() + lane),
                     _mm256_and_si256(weights_of(deviation, placement.weight_scale), usable));
  bounds.usable = _mm256_sub_epi32(bounds.usable, usable);
}

LINESCOPE_AVX2 PlacedBounds narrowed(const Bounds8& bounds) {
  PlacedBounds result = no_bounds();
  alignas(32) std::array<std::int32_t, 8> usable;
  _mm256_store_si256(reinterpret_cast<__m256i*>(usable.data()), bounds.usable);
  for (const std::int32_t count : usable) result.usable += static_cast<std::size_t>(count);
  for (std::size_t i = 0; i < 3; ++i) {
    alignas(32) std::array<std::int32_t, 8> low, high;
    _mm256_store_si256(reinterpret_cast<__m256i*>(low.data()), bounds.low[i]);
    _mm256_store_si256(reinterpret_cast<__m256i*>(high.data()), bounds.high[i]);
    for (const std::int32_t v : low)
      if (v >= 0) result.low[i] = std::min(result.low[i], v);  // all ones: nothing usable in the lane
    result.high[i] = *std::max_element(high.begin(), high.end());
  }
  return result;
}

__attribute__((target("avx2"))) PlacedBounds place_points_avx2(const LinePlacement& line,
                                                               std::span<const SurfacePoint> points,
                                                               PlacedBlock* placed) {
  const Placement8 placement = spread(line);
  Bounds8 bounds;
  for (int i = 0; i < 3; ++i) {
    bounds.low[i] = _mm256_set1_epi32(-1);
    bounds.high[i] = _mm256_setzero_si256();
  }
  bounds.usable = _mm256_setzero_si256();
  const std::size_t whole = points.size() / 8 * 8;
  for (std::size_t i = 0; i < whole; i += 8)
    place_eight(placement, points.data() + i, i % kPlacedPoints, placed[i / kPlacedPoints], bounds);
  if (whole == blocks_for(points.size()) * kPlacedPoints) return narrowed(bounds);
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  std::array<SurfacePoint, 8> rest;
  for (std::size_t i = whole; i < blocks_for(points.size()) * kPlacedPoints; i += 8) {
    rest.fill({{nan, nan, nan}, 0, 0});
    if (i < points.size())
      std::copy(points.begin() + static_cast<std::ptrdiff_t>(i), points.end(), rest.begin());
    place_eight(placement, rest.data(), i % kPlacedPoints, placed[i / kPlacedPoints], bounds);
  }
  return narrowed(bounds);
}
#undef LINESCOPE_AVX2
#endif

}  // namespace

bool LinePlacement::admits(const SurfacePoint& point) const {
  const Eigen::Vector3f& p = point.position;
  const std::array<float, 4> values{p.x(), p.y(), p.z(), point.standard_deviation};
  bool all = true;
  for (std::size_t i = 0; i < 4; ++i) all = all && values[i] >= low[i] && values[i] <= high[i];
  return all;
}

PlacedBounds place_points_portable(const LinePlacement& placement, std::span<const SurfacePoint> points,
                                   PlacedBlock* placed) {
  std::fill_n(placed, blocks_for(points.size()), PlacedBlock{});
  for (std::size_t i = 0; i < points.size(); ++i)
    place_point(placement, points[i], i % kPlacedPoints, placed[i / kPlacedPoints]);
  return bounds_of({placed, blocks_for(points.size())});
}

PlacedBounds place_points(const LinePlacement& placement, std::span<const SurfacePoint> points,
                          PlacedBlock* placed) {
#if defined(__x86_64__)
  if (has_avx2()) return place_points_avx2(placement, points, placed);
#endif
  return place_points_portable(placement, points, placed);
}

PlacedBounds bounds_of(std::span<const PlacedBlock> blocks) {
  PlacedBounds bounds = no_bounds();
  for (const PlacedBlock& block : blocks)
    for (std::size_t lane = 0; lane < kPlacedPoints; ++lane) include(bounds, block, lane);
  return bounds;
}

}  // namespace linescope
