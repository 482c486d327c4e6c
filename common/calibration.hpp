// Everything a scan needs to know about the instrument, and the file it is kept in (OpenCV YAML;
// docs/calibration.md).
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "common/camera_model.hpp"
#include "common/laser_bend.hpp"
#include "common/laser_plane.hpp"
#include "common/result.hpp"
#include "common/rigid_transform.hpp"
#include "common/time.hpp"

namespace linescope {

/// Tip and axis of the harvester in the frame of its sensor (sensor 3).
struct HarvesterCalibration {
  Eigen::Vector3d tip{0, 0, 0};   ///< mm
  Eigen::Vector3d axis{0, 0, 1};  ///< unit vector along the tube, from the tip back to the handle
};

struct Calibration {
  std::string name;  ///< for people, for example "camera II"
  CameraModel camera;
  LaserPlane laser;
  LaserBend laser_bend;  ///< flat: the laser's surface is the plane
  Rigid<Endoscope, CameraCv> endoscope_from_camera;
  HarvesterCalibration harvester;
  Nanoseconds camera_latency =
      0;  ///< picture's time stamp minus true middle of exposure, on the tracker's clock
  std::vector<std::string> notes;  ///< what was left at its default, what looks odd
};

/// Reads a file. Keys and shapes: docs/calibration.md. Failures name the file, the key and what to do.
Result<Calibration> load_calibration(const std::filesystem::path& file);

/// Writes a file that load_calibration reads back; the old file is replaced only when the new one is
/// complete.
Result<void> save_calibration(const Calibration& calibration, const std::filesystem::path& file);

/// The file's content: what the segment publishes for viewers.
Result<std::string> calibration_text(const Calibration& calibration);

/// The calibration in such a text; `origin` names it in failures.
Result<Calibration> calibration_from_text(const std::string& yaml, const std::string& origin);

/// Plausibility of the whole: camera, working depth of the laser plane, rigid parts. One sentence for the
/// first fault.
Result<void> validate(const Calibration& calibration);

/// The thesis's instruments as printed (section 3.2.2; b = 6 mm, alpha = 14 degrees).
Calibration thesis_camera_i();
Calibration thesis_camera_ii();

}  // namespace linescope
