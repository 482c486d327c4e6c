// The camera's part of a calibration file, and camera files of other programs.
#pragma once

#include <initializer_list>
#include <opencv2/core/mat.hpp>
#include <opencv2/core/persistence.hpp>
#include <optional>
#include <string>

#include "common/camera_model.hpp"
#include "common/result.hpp"

namespace linescope {

/// Only the camera of a file: OpenCV YAML (a calibration of ours, or image_width, image_height, camera_matrix
/// and distortion_coefficients of any other), ROS camera_info YAML (the same keys, matrices as rows, cols,
/// data; distortion_model plumb_bob), or one of the presets thesis-camera-i and thesis-camera-ii.
Result<CameraModel> load_camera(const std::string& file_or_preset);

/// For the readers of such files. Without naming the file; failures name the key.
Result<CameraModel> camera_from_yaml(const cv::FileStorage& storage);

/// A matrix of the wanted shape (columns 0: any number) under the first of `keys` that exists; nothing when
/// none does.
Result<std::optional<cv::Mat>> yaml_matrix(const cv::FileStorage& storage,
                                           std::initializer_list<const char*> keys, int rows, int cols);

}  // namespace linescope
