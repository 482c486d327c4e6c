#include "viewer/surface/line_quantizer.hpp"

#include <algorithm>
#include <cmath>

namespace linescope {
namespace {

constexpr double kReach = 1 << 18;  // intervals; keeps a point's steps within 31 bits

}  // namespace

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
  const std::size_t blocks = blocks_for(line.points.size());
  if (placed_.size() < blocks) placed_.resize(blocks);
  const PlacedBounds bounds = place_points(placement_, line.points, placed_.data());
  if (bounds.usable != line.points.size()) count_refused(line, counters);
  return {{placed_.data(), blocks}, bounds, placement_.corner};
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
  for (const SurfacePoint& point : line.points) {
    if (placement_.admits(point)) continue;
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
