#include "viewer/navigate/foot_search.hpp"

#include <cmath>
#include <optional>

namespace linescope {
namespace {

constexpr double kSteepest = 0.15;  // cosine between axis and normal below which they are taken not to meet
constexpr int kWideCells = 3;       // half width of the wide look

struct Walk {
  const LiveIndex& index;
  Eigen::Vector3d tip;
  Eigen::Vector3d axis;
  FootSearchOptions options;

  Eigen::Vector3d at(double ahead) const { return tip - ahead * axis; }
  bool within(double ahead) const { return ahead <= options.reach_ahead && ahead >= -options.reach_behind; }

  static std::optional<double> crossing(const FittedPlane& plane, const Walk& walk) {
    const double along = plane.normal.dot(walk.axis);
    if (!(along > kSteepest)) return std::nullopt;
    return plane.normal.dot(walk.tip - plane.centre) / along;
  }

  /// From a place near the surface to where the axis meets it; nothing when that leads away.
  std::optional<FoundFoot> settle(double ahead) const {
    for (int round = 0; round < 6; ++round) {
      const auto plane = index.plane_near(at(ahead));
      if (!plane) return std::nullopt;
      const auto next = crossing(*plane, *this);
      if (!next || !within(*next) || std::abs(*next - ahead) > 3 * index.grid().cell_size())
        return std::nullopt;
      const bool still = std::abs(*next - ahead) < 0.02;
      ahead = *next;
      if (still || round == 5) return FoundFoot{NormalReason::none, at(ahead), plane->normal, false};
    }
    return std::nullopt;
  }

  std::optional<FoundFoot> settle_wide(double ahead) const {
    const auto plane = index.wide_plane_near(at(ahead), kWideCells);
    if (!plane) return std::nullopt;
    const auto next = crossing(*plane, *this);
    if (!next || !within(*next) || std::abs(*next - ahead) > kWideCells * index.grid().cell_size())
      return std::nullopt;
    return FoundFoot{NormalReason::none, at(*next), plane->normal, true};
  }

  template <class Settle>
  std::optional<FoundFoot> first(double step, Settle&& settle) const {
    for (double s = 0; s <= std::max(options.reach_ahead, options.reach_behind); s += step) {
      if (s <= options.reach_ahead)
        if (auto found = settle(s)) return found;
      if (s > 0 && s <= options.reach_behind)
        if (auto found = settle(-s)) return found;
    }
    return std::nullopt;
  }
};

}  // namespace

FoundFoot find_foot(const LiveIndex& index, const Eigen::Vector3d& tip, const Eigen::Vector3d& axis,
                    const FootSearchOptions& options) {
  if (index.empty()) return {};
  const Walk walk{index, tip, axis, options};
  const double cell = index.grid().cell_size();
  if (auto found = walk.first(cell, [&](double s) { return walk.settle(s); })) return *found;
  if (auto found = walk.first((2 * kWideCells - 1) * cell, [&](double s) { return walk.settle_wide(s); }))
    return *found;
  FoundFoot none;
  const bool something = index.wide_plane_near(tip, 2 * kWideCells).has_value();
  none.reason = something ? NormalReason::axis_misses_surface : NormalReason::no_surface;
  return none;
}

}  // namespace linescope
