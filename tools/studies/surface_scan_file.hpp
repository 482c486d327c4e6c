// A scan of an ellipsoid in a text file: what study and benchmark programs of the surface hand to each other.
//
//   linescope-scan 1
//   axes_mm 25 22 25                    semi-axes of the ellipsoid; its centre is the origin
//   seen_mm 24.8 10.1                   extent along x and y of what was seen (all but the outermost
//   hundredth) line 1200000000 0.1 0.2 40.3 640    time (ns), place it was seen from (mm), number of points
//   1.2345 -4.3210 24.9000 0.26         a point (mm) and its standard deviation (mm)
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <vector>

#include "common/result.hpp"
#include "common/surface_point.hpp"
#include "common/time.hpp"

namespace linescope::study {

struct ScanFileLine {
  Nanoseconds time = 0;
  Eigen::Vector3d seen_from{0, 0, 0};
  std::vector<SurfacePoint> points;  ///< intensities are not kept
};

struct ScanFile {
  Eigen::Vector3d axes{0, 0, 0};
  Eigen::Vector2d seen{0, 0};
  std::vector<ScanFileLine> lines;
};

/// Along x and y, all but the outermost hundredth of the points (half of it on either side).
Eigen::Vector2d seen_extent(const std::vector<ScanFileLine>& lines);

Result<void> write_scan(const ScanFile& scan, const std::filesystem::path& file);
Result<ScanFile> read_scan(const std::filesystem::path& file);

}  // namespace linescope::study
