#include "viewer/surface/rim_lid.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

namespace linescope {
namespace {

using Corners = std::vector<Eigen::Vector3d>;
constexpr double kImpossible = std::numeric_limits<double>::infinity();

// Twice the area seen from above; positive counter-clockwise.
double seen_area(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

// The best triangulation of the corners from one to another, closed by the edge between the two.
class Table {
 public:
  Table(const Corners& rim, const std::function<bool(std::size_t, std::size_t)>& taken)
      : rim_(rim), cost_(rim.size() * rim.size(), kImpossible), apex_(cost_.size()) {
    double extent = 0;
    for (const Eigen::Vector3d& corner : rim) extent = std::max(extent, corner.head<2>().squaredNorm());
    least_ = 1e-9 * extent;
    for (std::size_t i = 0; i + 1 < rim.size(); ++i) cost_[at(i, i + 1)] = 0;
    for (std::size_t span = 2; span < rim.size(); ++span)
      for (std::size_t i = 0; i + span < rim.size(); ++i)
        if (span + 1 == rim.size() || !taken(i, i + span)) choose_apex(i, i + span);
  }

  bool possible() const { return cost_[at(0, rim_.size() - 1)] < kImpossible; }

  void collect(std::size_t i, std::size_t j, RimLid& lid) const {
    if (j == i + 1) return;
    const std::size_t k = apex_[at(i, j)];
    lid.triangles.push_back(
        {static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(k), static_cast<std::uint32_t>(j)});
    collect(i, k, lid);
    collect(k, j, lid);
  }

 private:
  std::size_t at(std::size_t i, std::size_t j) const { return i * rim_.size() + j; }

  void choose_apex(std::size_t i, std::size_t j) {
    for (std::size_t k = i + 1; k < j; ++k) {
      const double parts = cost_[at(i, k)] + cost_[at(k, j)];
      if (parts >= cost_[at(i, j)] || seen_area(rim_[i], rim_[k], rim_[j]) <= least_) continue;
      const double area = (rim_[k] - rim_[i]).cross(rim_[j] - rim_[i]).norm();
      if (parts + area >= cost_[at(i, j)]) continue;
      cost_[at(i, j)] = parts + area;
      apex_[at(i, j)] = k;
    }
  }

  const Corners& rim_;
  double least_ = 0;
  std::vector<double> cost_;
  std::vector<std::size_t> apex_;
};

struct Edge {
  std::uint32_t from = 0, to = 0;
  double length = 0;  // squared, seen from above
};

Edge longest_inner_edge(const RimLid& lid, std::size_t rim_corners) {
  const auto on_rim = [&](std::uint32_t a, std::uint32_t b) {
    return a < rim_corners && b < rim_corners && ((a + 1) % rim_corners == b || (b + 1) % rim_corners == a);
  };
  Edge longest;
  for (const auto& t : lid.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = t[i], b = t[(i + 1) % 3];
      const double length = (lid.corners[a] - lid.corners[b]).head<2>().squaredNorm();
      if (length > longest.length && !on_rim(a, b)) longest = {a, b, length};
    }
  return longest;
}

void split(RimLid& lid, const Edge& edge) {
  const auto middle = static_cast<std::uint32_t>(lid.corners.size());
  lid.corners.push_back(0.5 * (lid.corners[edge.from] + lid.corners[edge.to]));
  const std::size_t count = lid.triangles.size();
  for (std::size_t t = 0; t < count; ++t)
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [a, b, c] =
          std::array{lid.triangles[t][i], lid.triangles[t][(i + 1) % 3], lid.triangles[t][(i + 2) % 3]};
      if (!(a == edge.from && b == edge.to) && !(a == edge.to && b == edge.from)) continue;
      lid.triangles[t] = {a, middle, c};
      lid.triangles.push_back({middle, b, c});
      break;
    }
}

}  // namespace

std::optional<RimLid> triangulate_rim(const Corners& rim,
                                      const std::function<bool(std::size_t, std::size_t)>& taken) {
  if (rim.size() < 3 || rim.size() > kMaxRimCorners) return std::nullopt;
  const Table table(rim, taken);
  if (!table.possible()) return std::nullopt;
  RimLid lid{rim, {}};
  table.collect(0, rim.size() - 1, lid);
  return lid;
}

void split_long_edges(RimLid& lid, double longest, std::size_t most_corners) {
  const std::size_t rim_corners = lid.corners.size();
  while (lid.corners.size() < most_corners) {
    const Edge edge = longest_inner_edge(lid, rim_corners);
    if (edge.length <= longest * longest) return;
    split(lid, edge);
  }
}

}  // namespace linescope
