#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <opencv2/core.hpp>
#include <optional>

#include "common/calibration.hpp"
#include "common/camera_convention.hpp"
#include "common/camera_file.hpp"
#include "common/units.hpp"

namespace linescope {
namespace {

namespace fs = std::filesystem;

tl::unexpected<Error> in_file(const fs::path& file, const Error& error) {
  return fail(error.code, fmt::format("calibration {}: {}", file.string(), error.message));
}

Result<LaserPlane> read_laser(const cv::FileStorage& storage) {
  auto plane = yaml_matrix(storage, {"laser_plane"}, 1, 4);
  if (!plane) return tl::unexpected(plane.error());
  if (*plane) {
    return laser_plane_from_opencv(
        {(*plane)->at<double>(0), (*plane)->at<double>(1), (*plane)->at<double>(2), (*plane)->at<double>(3)});
  }
  const cv::FileNode b = storage["laser_baseline_mm"], alpha = storage["laser_alpha_deg"];
  if (b.empty() || alpha.empty()) {
    return fail(ErrorCode::invalid,
                "laser_plane (1x4, n.p + d = 0, OpenCV's camera frame, mm) is missing, and so are "
                "laser_baseline_mm and laser_alpha_deg");
  }
  return laser_plane_from_baseline(b.real(), radians_from_degrees(alpha.real()));
}

Result<LaserBend> read_bend(const cv::FileStorage& storage) {
  LaserBend bend;
  auto found = yaml_matrix(storage, {"laser_bend"}, 1, 0);
  if (!found) return tl::unexpected(found.error());
  if (!*found) return bend;
  const auto count = static_cast<std::size_t>((*found)->cols);
  if (count != LaserBend::kQuadratic && count != LaserBend::kCubic) {
    return fail(
        ErrorCode::invalid,
        fmt::format("laser_bend holds {} numbers, but must hold 3 (of x^2, xy, y^2) or 7 (and of x^3, "
                    "x^2 y, x y^2, y^3)",
                    count));
  }
  for (std::size_t i = 0; i < count; ++i) bend.b[i] = (*found)->at<double>(static_cast<int>(i));
  return turned_over(bend);
}

Result<Rigid<Endoscope, CameraCv>> read_hand_eye(const cv::FileStorage& storage,
                                                 std::vector<std::string>& notes) {
  auto found = yaml_matrix(storage, {"endoscope_from_camera", "tool_from_camera"}, 4, 4);
  if (!found) return tl::unexpected(found.error());
  if (!*found) {
    notes.emplace_back("endoscope_from_camera is missing: identity is used");
    return Rigid<Endoscope, CameraCv>{};
  }
  Eigen::Matrix4d t;
  for (int r = 0; r < 4; ++r)
    for (int c = 0; c < 4; ++c) t(r, c) = (*found)->at<double>(r, c);
  const Eigen::Matrix3d rotation = t.topLeftCorner<3, 3>();
  const double defect = (rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm();
  if (defect > 1e-3 || rotation.determinant() < 0 ||
      (t.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).norm() > 1e-9) {
    return fail(ErrorCode::invalid,
                "endoscope_from_camera is not a rigid transform (rotation, translation in mm, last row 0 0 0 "
                "1; OpenCV's camera frame)");
  }
  return Rigid<Endoscope, CameraCv>(Eigen::Quaterniond(rotation), t.topRightCorner<3, 1>());
}

Result<HarvesterCalibration> read_harvester(const cv::FileStorage& storage, std::vector<std::string>& notes) {
  HarvesterCalibration harvester;
  auto tip = yaml_matrix(storage, {"harvester_tip"}, 1, 3);
  if (!tip) return tl::unexpected(tip.error());
  auto axis = yaml_matrix(storage, {"harvester_axis"}, 1, 3);
  if (!axis) return tl::unexpected(axis.error());
  if (!*tip || !*axis) {
    notes.emplace_back("harvester_tip or harvester_axis is missing: the harvester is not calibrated");
    return harvester;
  }
  for (int i = 0; i < 3; ++i) {
    harvester.tip(i) = (*tip)->at<double>(i);
    harvester.axis(i) = (*axis)->at<double>(i);
  }
  if (harvester.axis.norm() < 1e-6) return fail(ErrorCode::invalid, "harvester_axis has no direction");
  harvester.axis.normalize();
  return harvester;
}

cv::Mat row(const Eigen::VectorXd& v) {
  cv::Mat m(1, static_cast<int>(v.size()), CV_64F);
  for (int i = 0; i < m.cols; ++i) m.at<double>(i) = v(i);
  return m;
}

/// A plane has no such key.
void write_bend(cv::FileStorage& out, const LaserBend& bend) {
  if (bend.flat()) return;
  out.writeComment("the plane's 1/z plus these times x^2 xy y^2 [x^3 x^2y xy^2 y^3], 1/mm");
  const LaserBend turned = turned_over(bend);
  out << "laser_bend"
      << row(Eigen::Map<const Eigen::VectorXd>(turned.b.data(), static_cast<Eigen::Index>(bend.terms())));
}

void write_all(cv::FileStorage& out, const Calibration& c) {
  out << "name" << c.name;
  out << "image_width" << c.camera.width << "image_height" << c.camera.height;
  out << "camera_matrix"
      << cv::Mat((cv::Mat_<double>(3, 3) << c.camera.fx, c.camera.skew, c.camera.cx, 0, c.camera.fy,
                  c.camera.cy, 0, 0, 1));
  out << "distortion_coefficients" << row(Eigen::Map<const Eigen::VectorXd>(c.camera.distortion.data(), 5));
  out.writeComment("n.p + d = 0 in OpenCV's camera frame (y down), mm");
  out << "laser_plane" << row(opencv_from_laser_plane(c.laser));
  write_bend(out, c.laser_bend);
  const Eigen::Matrix4d t = c.endoscope_from_camera.isometry().matrix();
  cv::Mat hand_eye(4, 4, CV_64F);
  for (int r = 0; r < 4; ++r)
    for (int k = 0; k < 4; ++k) hand_eye.at<double>(r, k) = t(r, k);
  out << "endoscope_from_camera" << hand_eye;
  out << "harvester_tip" << row(c.harvester.tip) << "harvester_axis" << row(c.harvester.axis);
  out << "camera_latency_ms" << milliseconds_from(c.camera_latency);
}

Result<Calibration> read_all(const cv::FileStorage& storage) {
  Calibration c;
  c.name = storage["name"].empty() ? "" : storage["name"].string();
  auto camera = camera_from_yaml(storage);
  if (!camera) return tl::unexpected(camera.error());
  c.camera = *camera;
  auto laser = read_laser(storage);
  if (!laser) return tl::unexpected(laser.error());
  c.laser = *laser;
  auto bend = read_bend(storage);
  if (!bend) return tl::unexpected(bend.error());
  c.laser_bend = *bend;
  auto hand_eye = read_hand_eye(storage, c.notes);
  if (!hand_eye) return tl::unexpected(hand_eye.error());
  c.endoscope_from_camera = *hand_eye;
  auto harvester = read_harvester(storage, c.notes);
  if (!harvester) return tl::unexpected(harvester.error());
  c.harvester = *harvester;
  if (const cv::FileNode latency = storage["camera_latency_ms"]; !latency.empty()) {
    c.camera_latency = static_cast<Nanoseconds>(latency.real() * 1e6);
  }
  if (auto ok = validate(c); !ok) return tl::unexpected(ok.error());
  return c;
}

}  // namespace

Result<Calibration> calibration_from_text(const std::string& yaml, const std::string& origin) {
  try {
    const cv::FileStorage storage(
        yaml, cv::FileStorage::READ | cv::FileStorage::MEMORY | cv::FileStorage::FORMAT_YAML);
    if (!storage.isOpened())
      return fail(ErrorCode::unreadable, fmt::format("calibration {}: not OpenCV YAML", origin));
    auto calibration = read_all(storage);
    if (!calibration) return in_file(origin, calibration.error());
    if (calibration->name.empty()) calibration->name = fs::path(origin).filename().string();
    return calibration;
  } catch (const cv::Exception& e) {
    return fail(ErrorCode::unreadable, fmt::format("calibration {}: not OpenCV YAML ({})", origin, e.err));
  }
}

Result<Calibration> load_calibration(const fs::path& file) {
  if (std::error_code ignored; !fs::is_regular_file(file, ignored)) {
    return fail(ErrorCode::not_found, fmt::format("calibration {}: no such file", file.string()));
  }
  std::ifstream in(file);
  const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  if (!in || text.empty())
    return fail(ErrorCode::unreadable, fmt::format("calibration {}: empty or not readable", file.string()));
  return calibration_from_text(text, file.string());
}

Result<std::string> calibration_text(const Calibration& calibration) {
  if (auto ok = validate(calibration); !ok) return tl::unexpected(ok.error());
  cv::FileStorage out(".yaml",
                      cv::FileStorage::WRITE | cv::FileStorage::MEMORY | cv::FileStorage::FORMAT_YAML);
  write_all(out, calibration);
  return out.releaseAndGetString();
}

Result<void> save_calibration(const Calibration& c, const fs::path& file) {
  auto text = calibration_text(c);
  if (!text) return in_file(file, text.error());
  const fs::path partial = file.string() + ".part";
  std::ofstream out(partial);
  out << *text;
  out.close();
  std::error_code error;
  if (out) fs::rename(partial, file, error);
  if (!out || error) {
    std::error_code ignored;
    fs::remove(partial, ignored);
    return fail(ErrorCode::permission, fmt::format("calibration {}: cannot be written there", file.string()));
  }
  return {};
}

}  // namespace linescope
