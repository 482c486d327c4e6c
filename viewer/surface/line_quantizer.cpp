#include "viewer/surface/line_quantizer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace linescope {
namespace {

constexpr double kReach = 1 << 18;  // intervals; keeps a point's steps within 31 bits

bool inside(const LinePlacement& placement, const std::array<float, 4>& values) {
  bool all = true;
  for (std::size_t i = 0; i < 4; ++i)
    all = all && values[i] >= placement.low[i] && values[i] <= placement.high[i];
  return all;
}

// Rounds weight_scale / sd^2 to 1 .. kMaxPointWeight; a deviation of 0 is unknown and counts as typical.
std::int32_t weight_of(float deviation, float scale) {
  if (deviation == 0) return kTypicalWeight;
  const float exact = scale / (deviation * deviation) + 0.5f;
  return static_cast<std::int32_t>(std::max(1.0f, std::min(exact, static_cast<float>(kMaxPointWeight))));
}

PlacedPoint placed_point(const LinePlacement& placement, const SurfacePoint& point) {
  const Eigen::Vector3f& p = point.position;
  if (!inside(placement, {p.x(), p.y(), p.z(), point.standard_deviation})) return {};
  const auto steps = [&](int axis) {
    return static_cast<std::int32_t>((p[axis] - placement.origin[static_cast<std::size_t>(axis)]) *
                                     placement.steps_per_mm);
  };
  return {steps(0), steps(1), steps(2), weight_of(point.standard_deviation, placement.weight_scale)};
}

void include(PlacedBounds& bounds, const PlacedPoint& p) {
  if (p.weight == 0) {
    ++bounds.refused;
    return;
  }
  const std::array<std::int32_t, 3> at{p.x, p.y, p.z};
  for (std::size_t i = 0; i < 3; ++i) {
    bounds.low[i] = std::min(bounds.low[i], at[i]);
    bounds.high[i] = std::max(bounds.high[i], at[i]);
  }
}

PlacedBounds no_bounds() {
  constexpr std::int32_t most = std::numeric_limits<std::int32_t>::max();
  return {{most, most, most, most}, {}, 0};
}

#if defined(__x86_64__)
// Two points' positions and deviations: x y z sd | x y z sd. The loads stay within the points' 20 bytes.
__attribute__((target("avx2"))) inline __m256 load_points(const SurfacePoint& a, const SurfacePoint& b) {
  const float *first = a.position.data(), *second = b.position.data();
  const __m256 front =
      _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(first)), _mm_loadu_ps(second), 1);
  const __m256 back =
      _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(first + 1)), _mm_loadu_ps(second + 1), 1);
  return _mm256_blend_ps(front, back, 0b10001000);
}

__attribute__((target("avx2"))) inline __m256 both(const std::array<float, 4>& values) {
  return _mm256_broadcast_ps(reinterpret_cast<const __m128*>(values.data()));
}

// Points two by two; the last of an odd number is placed twice, the second time into the same place.
__attribute__((target("avx2"))) PlacedBounds place_points_avx2(const LinePlacement& placement,
                                                               std::span<const SurfacePoint> points,
                                                               PlacedPoint* placed) {
  const __m256 low = both(placement.low), high = both(placement.high), origin = both(placement.origin);
  const __m256 scale = _mm256_set1_ps(placement.steps_per_mm),
               weight_scale = _mm256_set1_ps(placement.weight_scale);
  const __m256 half = _mm256_set1_ps(0.5f), one = _mm256_set1_ps(1.0f), zero = _mm256_setzero_ps();
  const __m256 most = _mm256_set1_ps(kMaxPointWeight), typical = _mm256_set1_ps(kTypicalWeight);
  __m256i lowest = _mm256_set1_epi32(-1), highest = _mm256_setzero_si256(), refusals = highest;
  for (std::size_t i = 0; i < points.size(); i += 2) {
    const std::size_t next = i + 1 < points.size() ? i + 1 : i;
    const __m256 values = load_points(points[i], points[next]);
    const __m256 outside =
        _mm256_or_ps(_mm256_cmp_ps(values, low, _CMP_NGE_UQ), _mm256_cmp_ps(values, high, _CMP_NLE_UQ));
    const __m256 steps = _mm256_mul_ps(_mm256_sub_ps(values, origin), scale);
    const __m256 exact = _mm256_add_ps(_mm256_div_ps(weight_scale, _mm256_mul_ps(values, values)), half);
    const __m256 clamped = _mm256_max_ps(_mm256_min_ps(exact, most), one);
    const __m256 weight = _mm256_blendv_ps(clamped, typical, _mm256_cmp_ps(values, zero, _CMP_EQ_OQ));
    const __m256i all = _mm256_cvttps_epi32(_mm256_blend_ps(steps, weight, 0b10001000));
    // A point is kept when none of its four values is outside.
    const __m256i any = _mm256_castps_si256(_mm256_or_ps(outside, _mm256_permute_ps(outside, 0b10110001)));
    const __m256i refused = _mm256_or_si256(any, _mm256_shuffle_epi32(any, 0b01001110));
    const __m256i result = _mm256_andnot_si256(refused, all);
    lowest = _mm256_min_epu32(lowest, _mm256_or_si256(result, refused));
    highest = _mm256_max_epu32(highest, result);
    refusals = _mm256_sub_epi32(refusals, refused);
    _mm_store_si128(reinterpret_cast<__m128i*>(placed + next), _mm256_extracti128_si256(result, 1));
    _mm_store_si128(reinterpret_cast<__m128i*>(placed + i), _mm256_castsi256_si128(result));
  }
  alignas(32) std::array<std::int32_t, 8> l, h, k;
  _mm256_store_si256(reinterpret_cast<__m256i*>(l.data()), lowest);
  _mm256_store_si256(reinterpret_cast<__m256i*>(h.data()), highest);
  _mm256_store_si256(reinterpret_cast<__m256i*>(k.data()), refusals);
  PlacedBounds bounds = no_bounds();
  for (std::size_t i = 0; i < 3; ++i) {
    // All ones means that no point was kept in the lane.
    for (const std::int32_t v : {l[i], l[i + 4]})
      if (v >= 0) bounds.low[i] = std::min(bounds.low[i], v);
    bounds.high[i] = std::max(h[i], h[i + 4]);
  }
  bounds.refused = static_cast<std::size_t>(k[0]) + static_cast<std::size_t>(k[4]);
  if (points.size() % 2 == 1 && placed[points.size() - 1].weight == 0) --bounds.refused;
  return bounds;
}
#endif

}  // namespace

PlacedBounds place_points_portable(const LinePlacement& placement, std::span<const SurfacePoint> points,
                                   PlacedPoint* placed) {
  PlacedBounds bounds = no_bounds();
  for (const SurfacePoint& point : points) {
    *placed = placed_point(placement, point);
    include(bounds, *placed++);
  }
  return bounds;
}

PlacedBounds place_points(const LinePlacement& placement, std::span<const SurfacePoint> points,
                          PlacedPoint* placed) {
#if defined(__x86_64__)
  static const bool has_avx2 = __builtin_cpu_supports("avx2") != 0;
  if (has_avx2) return place_points_avx2(placement, points, placed);
#endif
  return place_points_portable(placement, points, placed);
}

PlacedBounds bounds_of(std::span<const PlacedPoint> points) {
  PlacedBounds bounds = no_bounds();
  for (const PlacedPoint& point : points) include(bounds, point);
  return bounds;
}

LineQuantizer::LineQuantizer(const MesherOptions& options)
    : interval_(options.interval),
      max_distance_(options.max_distance),
      reach_(std::min(options.max_distance, kReach * options.interval)),
      max_deviation_(static_cast<float>(options.max_deviation)) {
  placement_.steps_per_mm = static_cast<float>(kSteps / options.interval);
  placement_.weight_scale =
      static_cast<float>(kTypicalWeight * options.typical_deviation * options.typical_deviation);
}

PlacedLine LineQuantizer::place(const SurfaceLine& line, MesherCounters& counters) {
  if (!line.seen_from.allFinite() || line.points.empty()) return {};
  prepare(line);
  if (placed_.size() < line.points.size()) placed_.resize(line.points.size());
  const PlacedBounds bounds = place_points(placement_, line.points, placed_.data());
  if (bounds.refused != 0) count_refused(line, counters);
  return {{placed_.data(), line.points.size()}, bounds, placement_.corner};
}

// The corner lies below all that is admitted, so that steps are positive and small enough for single
// precision to keep a sixteenth of a step.
void LineQuantizer::prepare(const SurfaceLine& line) {
  const double limit = (kGridLimit - 1) * interval_;
  std::array<std::int32_t, 3> corner{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double middle = line.seen_from[static_cast<Eigen::Index>(i)];
    placement_.low[i] = static_cast<float>(std::max(middle - reach_, -limit));
    placement_.high[i] = static_cast<float>(std::min(middle + reach_, limit));
    const double lowest =
        std::clamp(std::floor((middle - reach_) / interval_) - 1, -1.0 * kGridLimit, 1.0 * kGridLimit);
    corner[i] = static_cast<std::int32_t>(lowest);
    placement_.origin[i] = static_cast<float>(lowest * interval_);
  }
  placement_.low[3] = 0;
  placement_.high[3] = max_deviation_;
  placement_.corner = {corner[0], corner[1], corner[2]};
}

void LineQuantizer::count_refused(const SurfaceLine& line, MesherCounters& counters) const {
  for (std::size_t i = 0; i < line.points.size(); ++i) {
    if (placed_[i].weight != 0) continue;
    const SurfacePoint& point = line.points[i];
    const Eigen::Array3d away = (point.position.cast<double>() - line.seen_from).array().abs();
    if (!point.position.allFinite() || !std::isfinite(point.standard_deviation))
      ++counters.not_finite;
    else if ((away > max_distance_).any())
      ++counters.too_far;
    else if (!(point.standard_deviation >= 0 && point.standard_deviation <= max_deviation_))
      ++counters.too_uncertain;
    else
      ++counters.no_room;
  }
}

}  // namespace linescope
