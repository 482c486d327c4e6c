// A V4L2/UVC camera through OpenCV.
#pragma once

#include <memory>
#include <string>

#include "acquire/camera/camera_list.hpp"
#include "acquire/camera/capture_device.hpp"

namespace linescope {

/// What is asked of a camera. Anything it does not take is said in the remarks, never passed over.
struct V4l2Options {
  std::string device = {};        ///< "/dev/video2", "2", part of the name; empty: the first usable camera
  int width = 640;                ///< px
  int height = 480;               ///< px
  double rate_hz = 30;            ///< pictures per second
  std::string pixel_format = {};  ///< four characters, for example "MJPG"; empty: the camera's choice
  double exposure_ms = 0;         ///< 0: the camera's own automatic
  double gain = -1;               ///< camera's unit; -1: left as it is
  double white_balance_k = 0;     ///< locked at this colour temperature, kelvin; 0: as it is; -1: automatic
};

/// First fault of the options in one sentence.
Result<void> validate(const V4l2Options& options);

/// Not opened yet. Time stamps are the driver's (POS_MSEC, which V4L2 takes from CLOCK_MONOTONIC). After the
/// first open() only the camera of the same name is taken again, wherever it turns up.
std::unique_ptr<CaptureDevice> make_v4l2_device(const V4l2Options& options);

}  // namespace linescope
