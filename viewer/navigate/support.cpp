#include "viewer/navigate/support.hpp"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <limits>
#include <numbers>

namespace linescope {
namespace {

constexpr int kSectors = 64;

/// Which directions about the origin hold surface between two distances from it.
class Ring {
 public:
  Ring(double inner, double outer)
      : inner_(static_cast<float>(inner * inner)), outer_(static_cast<float>(outer * outer)) {}

  /// A piece of a line: its middle and both ends (spread times sqrt(3), the half length of evenly spread
  /// points).
  void add(float x, float y, float sx, float sy) {
    constexpr float kEnd = 1.7320508f;
    for (const float side : {-kEnd, 0.0f, kEnd}) add(x + side * sx, y + side * sy);
    nearest_ = std::min(nearest_, squared_distance(x, y, kEnd * sx, kEnd * sy));
  }

  double nearest() const { return std::sqrt(static_cast<double>(nearest_)); }

  double widest_empty() const {
    if (taken_.none()) return 2 * std::numbers::pi;
    int widest = 0, run = 0;
    for (int i = 0; i < 2 * kSectors; ++i) {
      run = taken_[static_cast<std::size_t>(i % kSectors)] ? 0 : run + 1;
      widest = std::max(widest, run);
    }
    return 2 * std::numbers::pi * widest / kSectors;
  }

 private:
  void add(float x, float y) {
    const float squared = x * x + y * y;
    if (squared > outer_ || squared < inner_) return;
    // The diamond's angle: monotone in the true one, no trigonometry; sectors differ a little in width.
    const float t = y / (std::abs(x) + std::abs(y));
    const float turn = x >= 0 ? (y >= 0 ? t : 4 + t) : 2 - t;
    taken_.set(static_cast<std::size_t>(turn * (kSectors / 4.0f)) % kSectors);
  }

  /// From the origin to a piece of a line with the given middle and half length.
  static float squared_distance(float x, float y, float hx, float hy) {
    const float squared = hx * hx + hy * hy;
    const float t = squared > 0 ? std::clamp(-(x * hx + y * hy) / squared, -1.0f, 1.0f) : 0.0f;
    const float px = x + t * hx, py = y + t * hy;
    return px * px + py * py;
  }

  float inner_, outer_;
  float nearest_ = std::numeric_limits<float>::max();
  std::bitset<kSectors> taken_;
};

void count(const Patch& patch, Support& support) {
  std::bitset<Patch::kMostLines> used;
  for (std::size_t i = 0; i < static_cast<std::size_t>(patch.size); ++i) {
    support.counts.points_rejected += patch.wild[i];
    if (!(patch.weight[i] > 0)) {
      support.counts.points_rejected += patch.points[i];
      continue;
    }
    support.counts.points += patch.points[i];
    used.set(patch.line[i]);
  }
  support.counts.lines = static_cast<int>(used.count());
  support.counts.lines_rejected = patch.line_count - support.counts.lines;
  support.newest = std::numeric_limits<Nanoseconds>::min();
  for (std::size_t l = 0; l < static_cast<std::size_t>(patch.line_count); ++l)
    if (used[l]) support.newest = std::max(support.newest, patch.lines[l].time);
}

NormalReason verdict(const Patch& patch, const Support& support, Nanoseconds now,
                     const SupportOptions& options) {
  if (support.counts.points == 0) return NormalReason::no_surface;
  const double outer = std::min(options.ring, patch.radius);
  Ring ring(options.clear * outer / options.ring, outer);
  for (std::size_t i = 0; i < static_cast<std::size_t>(patch.size); ++i)
    if (patch.weight[i] > 0) ring.add(patch.x[i], patch.y[i], patch.sx[i], patch.sy[i]);
  if (ring.nearest() > options.largest_hole)
    return ring.widest_empty() > options.widest_empty_angle ? NormalReason::one_sided : NormalReason::gap;
  if (support.counts.points < options.fewest_points) return NormalReason::too_few_points;
  if (support.counts.lines < options.fewest_lines) return NormalReason::too_few_lines;
  if (ring.widest_empty() > options.widest_empty_angle) return NormalReason::one_sided;
  if (now - support.newest > options.oldest) return NormalReason::too_old;
  return NormalReason::none;
}

}  // namespace

Support judge_support(const Patch& patch, Nanoseconds now, const SupportOptions& options) {
  Support support;
  count(patch, support);
  support.reason = verdict(patch, support, now, options);
  return support;
}

}  // namespace linescope
