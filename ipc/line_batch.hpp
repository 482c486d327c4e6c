// Copying out the lines of a scan, step by step, and knowing what was missed.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "common/surface_point.hpp"
#include "ipc/segment_types.hpp"

namespace linescope {

/// Leaves new elements uninitialised: they are overwritten at once, and a million zeros would cost as much as
/// the copying.
template <class T>
struct UninitialisedAllocator : std::allocator<T> {
  template <class U>
  struct rebind {
    using other = UninitialisedAllocator<U>;
  };
  template <class U>
  void construct(U*) const noexcept {}
  template <class U, class First, class... Rest>
  void construct(U* at, First&& first, Rest&&... rest) const {
    ::new (static_cast<void*>(at)) U(std::forward<First>(first), std::forward<Rest>(rest)...);
  }
};

using PointBuffer = std::vector<SurfacePoint, UninitialisedAllocator<SurfacePoint>>;

/// Where a reader stands. A fresh one begins with the first line of the current scan.
struct LineCursor {
  std::uint32_t generation = 0;   ///< 0: nothing read yet
  std::uint32_t next_line = 0;    ///< in that generation
  std::uint64_t next_serial = 0;  ///< the first serial not yet seen
  std::uint64_t session_id = 0;   ///< a cursor of another session begins from scratch
};

/// What one read_lines gave.
struct LineBatch {
  std::vector<Line> lines;    ///< Line::first_point counts in `points`
  PointBuffer points;         ///< world, mm, without gaps
  std::uint32_t scan_id = 0;  ///< 0: no scan yet
  /// The scan was cleared, begun anew or shortened by an undo since the last call: forget the surface made of
  /// it. What still counts is delivered again from the first line.
  bool restarted = false;
  std::uint64_t missed =
      0;              ///< lines published since the last call that can no longer be had (their scan is over)
  bool more = false;  ///< there are more lines than max_points allowed
  std::uint64_t damaged =
      0;  ///< lines whose checksum is wrong; they are left out. Never happens with our writer.

  std::span<const SurfacePoint> points_of(const Line& line) const {
    return {points.data() + line.first_point, line.point_count};
  }
  void clear();
};

}  // namespace linescope
