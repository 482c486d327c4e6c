// Pictures of what a calibration leaves: where the corners lay, how far everything is from the fit.
#pragma once

#include <opencv2/core/mat.hpp>

#include "tools/calibrate/camera_fit.hpp"
#include "tools/calibrate/laser_points.hpp"
#include "tools/calibrate/sheet_fit.hpp"

namespace linescope::calibrate {

/// All corners of all pictures in the camera's picture, with the cells that count for the coverage.
cv::Mat plot_coverage(const Session& session);

/// From each corner seen to where `camera` puts it, enlarged; the scale is written below. Poses are fitted
/// anew for `camera`, so that another calibration can be compared on the same pictures.
cv::Mat plot_corner_errors(const Session& session, const BoardOptions& board, const CameraModel& camera,
                           const CameraFit& fit);

/// Distance from the surface over depth, one colour per picture.
cv::Mat plot_laser_errors(const std::vector<LaserPicture>& pictures, const Sheet& sheet);

/// One bar per picture; those left out as outliers in red.
cv::Mat plot_items(const Quality& quality);

}  // namespace linescope::calibrate
