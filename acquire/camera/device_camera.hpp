// A camera at this machine: V4L2/UVC through OpenCV, with its own capture thread, unplug and replug.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "acquire/camera/camera_source.hpp"

namespace linescope {

/// What is asked of a camera. Anything the camera does not take is said in status().remarks, never passed
/// over.
struct DeviceCameraOptions {
  std::string
      device;        ///< "/dev/video2", "2", or part of the name ("USB Camera"); empty: the first usable one
  int width = 640;   ///< px
  int height = 480;  ///< px
  double rate_hz = 30;         ///< pictures per second
  std::string pixel_format;    ///< four characters, for example "MJPG" or "YUYV"; empty: the camera's choice
  double exposure_ms = 0;      ///< 0: automatic
  double gain = -1;            ///< camera's unit; -1: left as it is
  double white_balance_k = 0;  ///< locked at this colour temperature, kelvin; 0: automatic stays on
};

/// First fault of the options in one sentence.
Result<void> validate(const DeviceCameraOptions& options);

/// A video node of this machine, for `--list`.
struct CameraInfo {
  std::string path;  ///< "/dev/video0"
  std::string name;  ///< as the driver calls it
  bool usable = false;
  std::string obstacle;  ///< one sentence why not, empty when usable
};

/// All video nodes with the reason why one cannot be used. Opens each for a moment; disturbs no running
/// capture.
std::vector<CameraInfo> list_cameras();

/// The camera that `choice` (path, index, part of the name, or empty for the first usable one) means, or one
/// sentence with what there is instead.
Result<CameraInfo> choose_camera(const std::string& choice, const std::vector<CameraInfo>& cameras);

/// Live source over a real camera.
std::unique_ptr<CameraSource> make_device_camera(const DeviceCameraOptions& options);

}  // namespace linescope
