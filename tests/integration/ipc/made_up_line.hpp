// Lines whose every number follows from their serial, so that a reader in another process can tell a whole
// one from a torn or wrong one without trusting any checksum.
#pragma once

#include <span>
#include <vector>

#include "common/surface_point.hpp"
#include "ipc/segment_types.hpp"

namespace linescope::testing {

inline std::size_t made_up_count(std::uint64_t serial) {
  return 1 + static_cast<std::size_t>(serial * 7919 % 640);
}

inline SurfacePoint made_up_point(std::uint64_t serial, std::size_t i) {
  const auto s = static_cast<float>(serial % 65'536);
  const auto f = static_cast<float>(i);
  return {{s, f, s - f}, static_cast<float>((serial + i) % 256), 0.25F * f};
}

inline void make_up(std::uint64_t serial, std::vector<SurfacePoint>& points) {
  points.resize(made_up_count(serial));
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = made_up_point(serial, i);
}

inline ScanLineInfo made_up_info(std::uint64_t serial, Nanoseconds now) {
  ScanLineInfo info;
  info.time = now;
  info.frame = serial;
  const auto s = static_cast<double>(serial);
  info.endoscope = {{Eigen::Quaterniond(1, 0, 0, 0), {s, 1, 2}}, ToolState::ok};
  info.object = {{Eigen::Quaterniond(0, 1, 0, 0), {3, s, 4}}, ToolState::ok};
  info.harvester = {{Eigen::Quaterniond(0, 0, 1, 0), {5, 6, s}}, ToolState::out_of_view};
  info.quality.coverage = 0.5F;
  return info;
}

/// Whether everything is as it was made up. The frame number repeats the serial.
inline bool is_made_up(const Line& line, std::span<const SurfacePoint> points) {
  const auto s = static_cast<double>(line.serial);
  bool good = line.frame == line.serial && points.size() == made_up_count(line.serial) &&
              line.endoscope.world_from_tool.translation() == Eigen::Vector3d(s, 1, 2) &&
              line.object.world_from_tool.translation() == Eigen::Vector3d(3, s, 4) &&
              line.harvester.world_from_tool.translation() == Eigen::Vector3d(5, 6, s);
  for (std::size_t i = 0; good && i < points.size(); ++i) {
    const SurfacePoint wanted = made_up_point(line.serial, i);
    good = points[i].position == wanted.position && points[i].intensity == wanted.intensity &&
           points[i].standard_deviation == wanted.standard_deviation;
  }
  return good;
}

}  // namespace linescope::testing
