#include "viewer/navigate/patch.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace linescope {
namespace {

constexpr float kGrazing =
    -0.2f;  // lines that looked at the surface under less than 12 degrees, or from behind

/// From a line's place in the index to its place in the patch: open addressing in fixed room.
class LineTable {
 public:
  explicit LineTable(Patch& patch) : patch_(patch) { slots_.fill(kFree); }

  /// -1 when there is no room for another line.
  int find_or_make(const LiveIndex& index, std::uint32_t place) {
    for (std::size_t i = place * 2654435761u % kSlots;; i = (i + 1) % kSlots) {
      if (slots_[i] == kFree) return make(index, place, i);
      if (patch_.lines[slots_[i]].place == place) return slots_[i];
    }
  }

 private:
  static constexpr std::size_t kSlots = 2 * Patch::kMostLines;
  static constexpr std::uint16_t kFree = 0xffff;

  int make(const LiveIndex& index, std::uint32_t place, std::size_t slot) {
    if (patch_.line_count == Patch::kMostLines) return -1;
    slots_[slot] = static_cast<std::uint16_t>(patch_.line_count);
    PatchLine& line = patch_.lines[slots_[slot]];
    const Eigen::Vector3f view = patch_.frame.axes().cast<float>().transpose() * index.line(place).view;
    line = {place, index.line(place).time, Eigen::Vector2f::Zero(), view.head<2>() / view.z()};
    return patch_.line_count++;
  }

  Patch& patch_;
  std::array<std::uint16_t, kSlots> slots_;
};

class Gatherer {
 public:
  Gatherer(const LiveIndex& index, double height, Patch& patch)
      : index_(index),
        patch_(patch),
        table_(patch),
        axes_(patch.frame.axes().cast<float>()),
        origin_(patch.frame.origin().cast<float>()),
        radius2_(static_cast<float>(patch.radius * patch.radius)),
        height_(static_cast<float>(height)) {}

  void take(const Segment& segment) {
    const Eigen::Vector3f p = axes_.transpose() * (segment.mean - origin_);
    if (p.x() * p.x() + p.y() * p.y() > radius2_ || std::abs(p.z()) > height_) return;
    if (index_.line(segment.line).view.dot(axes_.col(2)) > kGrazing) return;
    const int line = patch_.size < Patch::kMostSegments ? table_.find_or_make(index_, segment.line) : -1;
    if (line < 0) {
      ++patch_.left_over;
      return;
    }
    store(segment, p, line);
  }

 private:
  void store(const Segment& segment, const Eigen::Vector3f& p, int line) {
    const auto i = static_cast<std::size_t>(patch_.size++);
    const Eigen::Vector2f spread = (axes_.transpose() * segment.spread).head<2>();
    patch_.x[i] = p.x();
    patch_.y[i] = p.y();
    patch_.z[i] = p.z();
    patch_.sx[i] = spread.x();
    patch_.sy[i] = spread.y();
    patch_.variance[i] = segment.variance;
    patch_.weight[i] = 1;
    patch_.line[i] = static_cast<std::uint16_t>(line);
    patch_.points[i] = segment.count;
    patch_.wild[i] = segment.rejected;
    Eigen::Vector2f& direction = patch_.lines[static_cast<std::size_t>(line)].direction;
    direction += direction.dot(spread) < 0 ? Eigen::Vector2f(-spread) : spread;
  }

  const LiveIndex& index_;
  Patch& patch_;
  LineTable table_;
  Eigen::Matrix3f axes_;
  Eigen::Vector3f origin_;
  float radius2_;
  float height_;
};

}  // namespace

PatchFrame::PatchFrame(const Eigen::Vector3d& origin, const Eigen::Vector3d& out) : origin_(origin) {
  const Eigen::Vector3d z = out.normalized();
  int smallest = 0;
  z.cwiseAbs().minCoeff(&smallest);
  const Eigen::Vector3d x = Eigen::Vector3d::Unit(smallest).cross(z).normalized();
  axes_ << x, z.cross(x), z;
}

void gather(const LiveIndex& index, const PatchFrame& frame, double radius, double height, Patch& patch) {
  patch.frame = frame;
  patch.radius = radius;
  patch.size = patch.line_count = patch.left_over = 0;
  Gatherer gatherer(index, height, patch);
  const double reach = std::hypot(radius, std::min(height, radius));
  // Where a place was scanned many times, every cell gives its newest segments, so that none of the cells
  // goes empty.
  int cells = 0, segments = 0;
  index.visit_cells(frame.origin(), reach, [&](std::span<const Segment> cell, std::size_t) {
    ++cells;
    segments += static_cast<int>(cell.size());
  });
  const auto most =
      static_cast<std::size_t>(segments <= Patch::kMostSegments ? segments : Patch::kMostSegments / cells);
  index.visit_cells(frame.origin(), reach, [&](std::span<const Segment> cell, std::size_t next) {
    const std::size_t n = cell.size(), taken = std::min(n, most);
    for (std::size_t i = 0; i < taken; ++i) gatherer.take(cell[(next + 2 * n - 1 - i) % n]);
    patch.left_over += static_cast<int>(n - taken);
  });
}

void shrink(Patch& patch, double radius) {
  const auto limit = static_cast<float>(radius * radius);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(patch.size); ++i) {
    if (patch.x[i] * patch.x[i] + patch.y[i] * patch.y[i] > limit) continue;
    for (Patch::Row* row :
         {&patch.x, &patch.y, &patch.z, &patch.sx, &patch.sy, &patch.variance, &patch.weight})
      (*row)[kept] = (*row)[i];
    patch.line[kept] = patch.line[i];
    patch.points[kept] = patch.points[i];
    patch.wild[kept] = patch.wild[i];
    ++kept;
  }
  patch.size = static_cast<int>(kept);
  patch.radius = radius;
}

}  // namespace linescope
