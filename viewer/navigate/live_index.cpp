#include "viewer/navigate/live_index.hpp"

#include <fmt/format.h>

#include <cmath>

namespace linescope {

Result<void> validate(const LiveIndexOptions& o) {
  if (!(o.cell_size >= 0.2 && o.cell_size <= 10))
    return fail(ErrorCode::invalid,
                fmt::format("navigation index: cell size {} mm is not within 0.2 to 10 mm", o.cell_size));
  if (o.segments_per_cell < 4 || o.segments_per_cell > 1024)
    return fail(
        ErrorCode::invalid,
        fmt::format("navigation index: {} segments per cell are not within 4 to 1024", o.segments_per_cell));
  if (o.cells < 1000)
    return fail(ErrorCode::invalid,
                fmt::format("navigation index: {} cells hold no scan; allow 1000 or more", o.cells));
  if (!(o.plane_reach > 0 && o.plane_reach <= 1.6 * o.cell_size))
    return fail(
        ErrorCode::invalid,
        fmt::format("navigation index: reach {} mm of the plain normal is not within 0 and 1.6 cells, {} mm",
                    o.plane_reach, 1.6 * o.cell_size));
  if (o.plane_points < 3)
    return fail(ErrorCode::invalid,
                fmt::format("navigation index: {} points span no plane; ask for 3 or more", o.plane_points));
  if (!(o.segments.unknown_deviation > 0 && o.segments.cut > 0 && o.segments.smallest_cut > 0))
    return fail(ErrorCode::invalid, "navigation index: deviation and cuts of the segments must be positive");
  return {};
}

void LiveIndex::clear() {
  grid_.clear();
  sums_.clear();
  cells_.clear();
  lines_.clear();
  counts_ = {};
}

void LiveIndex::add(const LineInfo& line, const std::vector<CutSegment>& segments, std::uint64_t unusable) {
  counts_.points_not_finite += unusable;
  const auto place = static_cast<std::uint32_t>(lines_.size());
  bool taken = false;
  for (const CutSegment& cut : segments) {
    std::int32_t number = grid_.find(cut.cell);
    if (number == CellGrid::kNone && grid_.size() >= options_.cells) {
      counts_.points_no_room += cut.points.size();
      continue;
    }
    number = grid_.find_or_make(cut.cell);
    if (static_cast<std::size_t>(number) == cells_.size()) {
      cells_.emplace_back();
      sums_.emplace_back();
    }
    CellSums& sums = sums_[static_cast<std::size_t>(number)];
    sums.moments.add_shifted(cut.moments, Eigen::Vector3d::Zero());
    sums.view_sum += static_cast<double>(cut.segment.count) * line.view.cast<double>();
    Segment segment = cut.segment;
    segment.line = place;
    put(cells_[static_cast<std::size_t>(number)], segment, cut.points);
    counts_.points += cut.points.size();
    counts_.points_wild += segment.rejected;
    taken = true;
  }
  if (taken) lines_.push_back(line);
  ++(taken ? counts_.lines : counts_.lines_rejected);
}

void LiveIndex::put(CellLines& cell, const Segment& segment, const std::vector<Eigen::Vector3f>& points) {
  if (cell.segments.size() < static_cast<std::size_t>(options_.segments_per_cell)) {
    cell.segments.push_back(segment);
    cell.points.push_back(points);
    return;
  }
  counts_.points_replaced += cell.points[cell.next].size();
  cell.segments[cell.next] = segment;
  cell.points[cell.next] = points;
  cell.next = (cell.next + 1) % cell.segments.size();
}

std::optional<FittedPlane> LiveIndex::oriented_plane(const Moments& sum, const Eigen::Vector3d& view,
                                                     const Eigen::Vector3d& place) const {
  auto plane = plane_through(sum);
  if (!plane) return std::nullopt;
  plane->centre += place;
  if (plane->normal.dot(view) > 0) plane->normal = -plane->normal;
  return plane;
}

std::optional<FittedPlane> LiveIndex::plane_near(const Eigen::Vector3d& place) const {
  if (!place.allFinite() || !grid_.holds(place)) return std::nullopt;
  const CellIndex home = grid_.cell_of(place);
  const double reach = 1 / (options_.plane_reach * options_.plane_reach);
  Moments sum;
  Eigen::Vector3d view = Eigen::Vector3d::Zero();
  double points = 0;
  const CellIndex one = CellIndex::Ones();
  grid_.visit_box(home - one, home + one, [&](std::int32_t number, const CellIndex& c) {
    const CellSums& cell = sums_[static_cast<std::size_t>(number)];
    const Eigen::Vector3d offset = grid_.centre_of(c) - place;
    const double u = 1 - (offset + cell.moments.first / cell.moments.n).squaredNorm() * reach;
    if (u <= 0) return;
    sum.add_shifted(cell.moments, offset, u);
    view += u * cell.view_sum;
    points += cell.moments.n;
  });
  if (points < options_.plane_points) return std::nullopt;
  return oriented_plane(sum, view, place);
}

std::optional<FittedPlane> LiveIndex::wide_plane_near(const Eigen::Vector3d& place, int half_width) const {
  if (!place.allFinite() || !grid_.holds(place)) return std::nullopt;
  const CellIndex home = grid_.cell_of(place);
  Moments sum;
  Eigen::Vector3d view = Eigen::Vector3d::Zero();
  const CellIndex width = CellIndex::Constant(half_width);
  grid_.visit_box(home - width, home + width, [&](std::int32_t number, const CellIndex& c) {
    const CellSums& cell = sums_[static_cast<std::size_t>(number)];
    sum.add_shifted(cell.moments, grid_.centre_of(c) - place);
    view += cell.view_sum;
  });
  if (sum.n < options_.plane_points) return std::nullopt;
  return oriented_plane(sum, view, place);
}

std::optional<Eigen::Vector3d> LiveIndex::view_near(const Eigen::Vector3d& place, double radius) const {
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(radius);
  Eigen::Vector3d view = Eigen::Vector3d::Zero();
  grid_.visit_box(grid_.cell_of(place - reach), grid_.cell_of(place + reach),
                  [&](std::int32_t number, const CellIndex&) {
                    view += sums_[static_cast<std::size_t>(number)].view_sum;
                  });
  if (!(view.norm() > 0)) return std::nullopt;
  return view.normalized();
}

void LiveIndex::collect_shell(const Eigen::Vector3d& centre, double inner, double outer,
                              std::vector<Eigen::Vector3f>& out) const {
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(outer);
  const Eigen::Vector3f c = centre.cast<float>();
  const auto low = static_cast<float>(inner * inner), high = static_cast<float>(outer * outer);
  grid_.visit_box(grid_.cell_of(centre - reach), grid_.cell_of(centre + reach),
                  [&](std::int32_t number, const CellIndex&) {
                    for (const auto& points : cells_[static_cast<std::size_t>(number)].points)
                      for (const Eigen::Vector3f& p : points) {
                        const float d = (p - c).squaredNorm();
                        if (d >= low && d <= high) out.push_back(p);
                      }
                  });
}

}  // namespace linescope
