#include "common/camera_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <opencv2/core.hpp>

#include "common/calibration.hpp"

namespace linescope {
namespace {

/// OpenCV's own form, or ROS's: rows, cols and data without a type.
cv::Mat matrix_in(const cv::FileNode& node) {
  cv::Mat m;
  if (!node.isMap() || !node["dt"].empty()) return node >> m, m;
  const cv::FileNode data = node["data"];
  m.create(static_cast<int>(node["rows"]), static_cast<int>(node["cols"]), CV_64F);
  if (data.size() != m.total())
    throw cv::Exception(cv::Error::StsParseError, "wrong number of values", "", "", 0);
  for (std::size_t i = 0; i < data.size(); ++i)
    m.at<double>(static_cast<int>(i)) = data[static_cast<int>(i)].real();
  return m;
}

/// OpenCV reads only what begins with its own mark; ROS writes none.
std::string with_yaml_mark(const std::string& text) {
  return text.rfind("%YAML", 0) == 0 ? text : "%YAML:1.0\n" + text;
}

Result<void> check_distortion_model(const cv::FileStorage& storage) {
  const cv::FileNode model = storage["distortion_model"];
  if (model.empty() || model.string() == "plumb_bob") return {};
  return fail(
      ErrorCode::unsupported,
      fmt::format("distortion_model is {}, but only plumb_bob (k1 k2 p1 p2 k3) is understood: calibrate the "
                  "camera with that model",
                  model.string()));
}

Result<CameraModel> camera_in(const std::string& text) {
  try {
    const cv::FileStorage storage(
        with_yaml_mark(text), cv::FileStorage::READ | cv::FileStorage::MEMORY | cv::FileStorage::FORMAT_YAML);
    if (!storage.isOpened()) return fail(ErrorCode::unreadable, "not YAML");
    if (auto ok = check_distortion_model(storage); !ok) return tl::unexpected(ok.error());
    auto camera = camera_from_yaml(storage);
    if (camera)
      if (auto ok = validate(*camera); !ok) return tl::unexpected(ok.error());
    return camera;
  } catch (const cv::Exception& e) {
    return fail(ErrorCode::unreadable, fmt::format("not YAML as OpenCV or ROS write it ({})", e.err));
  }
}

}  // namespace

Result<std::optional<cv::Mat>> yaml_matrix(const cv::FileStorage& storage,
                                           std::initializer_list<const char*> keys, int rows, int cols) {
  for (const char* key : keys) {
    const cv::FileNode node = storage[key];
    if (node.empty()) continue;
    cv::Mat m;
    try {
      m = matrix_in(node);
      m.convertTo(m, CV_64F);
    } catch (const cv::Exception&) {
      return fail(ErrorCode::invalid,
                  fmt::format("{} is not a matrix (!!opencv-matrix with rows, cols, dt, data)", key));
    }
    const bool transposed = rows == 1 && m.rows != 1 && m.cols == 1;
    if (transposed) m = m.t();
    if (m.rows != rows || (cols > 0 && m.cols != cols)) {
      return fail(ErrorCode::invalid, fmt::format("{} is {}x{}, but must be {}x{}", key, m.rows, m.cols, rows,
                                                  cols > 0 ? cols : 4));
    }
    if (!cv::checkRange(m))
      return fail(ErrorCode::invalid, fmt::format("{} holds a number that is not finite", key));
    return m.clone();
  }
  return std::nullopt;
}

Result<CameraModel> camera_from_yaml(const cv::FileStorage& storage) {
  CameraModel camera;
  camera.width = static_cast<int>(storage["image_width"].real());
  camera.height = static_cast<int>(storage["image_height"].real());
  if (storage["image_width"].empty() || storage["image_height"].empty()) {
    return fail(
        ErrorCode::invalid,
        "image_width and image_height are missing: the size in pixels at which the camera was calibrated");
  }
  auto k = yaml_matrix(storage, {"camera_matrix"}, 3, 3);
  if (!k) return tl::unexpected(k.error());
  if (!*k) return fail(ErrorCode::invalid, "camera_matrix is missing");
  const cv::Mat& m = **k;
  if (std::abs(cv::determinant(m)) < 1e-9) return fail(ErrorCode::invalid, "camera_matrix is singular");
  camera.fx = m.at<double>(0, 0);
  camera.skew = m.at<double>(0, 1);
  camera.cx = m.at<double>(0, 2);
  camera.fy = m.at<double>(1, 1);
  camera.cy = m.at<double>(1, 2);
  auto d = yaml_matrix(storage, {"distortion_coefficients"}, 1, 0);
  if (!d) return tl::unexpected(d.error());
  if (!*d)
    return fail(ErrorCode::invalid,
                "distortion_coefficients is missing (k1 k2 p1 p2 or k1 k2 p1 p2 k3; zeros for none)");
  if ((*d)->cols != 4 && (*d)->cols != 5) {
    return fail(
        ErrorCode::invalid,
        fmt::format("distortion_coefficients has {} numbers; 4 (k1 k2 p1 p2) or 5 (and k3) are understood",
                    (*d)->cols));
  }
  for (int i = 0; i < (*d)->cols; ++i) camera.distortion[static_cast<std::size_t>(i)] = (*d)->at<double>(i);
  return camera;
}

Result<CameraModel> load_camera(const std::string& file_or_preset) {
  if (file_or_preset == "thesis-camera-i") return thesis_camera_i().camera;
  if (file_or_preset == "thesis-camera-ii") return thesis_camera_ii().camera;
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file_or_preset, ignored))
    return fail(ErrorCode::not_found, fmt::format("camera {}: no such file", file_or_preset));
  std::ifstream in(file_or_preset);
  const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  auto camera = camera_in(text);
  if (!camera)
    return fail(camera.error().code, fmt::format("camera {}: {}", file_or_preset, camera.error().message));
  return camera;
}

}  // namespace linescope
