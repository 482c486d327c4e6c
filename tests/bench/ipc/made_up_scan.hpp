// What the benchmarks publish: a frame of 640 points, and where the bytes go.
#pragma once

#include <unistd.h>

#include <string>
#include <vector>

#include "ipc/segment_writer.hpp"

namespace linescope::bench {

inline constexpr std::size_t kPointsPerLine = 640;
inline constexpr std::size_t kLinesPerScan =
    1'200;  ///< 15 MiB of points: cycling through them leaves the L2 cache
inline constexpr std::size_t kLineBytes = kPointsPerLine * sizeof(SurfacePoint) + sizeof(ls_line_record);

inline std::vector<SurfacePoint> one_line() {
  std::vector<SurfacePoint> points(kPointsPerLine);
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = {{static_cast<float>(i), 2, 3}, 100, 0.1F};
  return points;
}

inline SegmentOptions scan_options(const std::string& what, std::size_t lines = kLinesPerScan) {
  SegmentOptions o;
  o.name = "linescope-bench-" + what + "-" + std::to_string(::getpid());
  o.line_capacity = static_cast<std::uint32_t>(lines);
  o.point_capacity = static_cast<std::uint32_t>(lines * kPointsPerLine);
  return o;
}

}  // namespace linescope::bench
