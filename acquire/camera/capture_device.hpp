// What the live camera source needs from a camera: the seam between our thread and somebody's driver.
#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "acquire/pull.hpp"
#include "common/result.hpp"
#include "common/time.hpp"

namespace linescope {

/// What opening a camera gave.
struct OpenedDevice {
  std::string description;           ///< "/dev/video0 (USB Camera), 640x480 px at 30 Hz, MJPG"
  Nanoseconds period = 0;            ///< between two pictures, 0 when the camera does not say
  std::vector<std::string> remarks;  ///< one sentence per setting that the camera did not accept
};

/// Calls come from one thread at a time.
class CaptureDevice {
 public:
  virtual ~CaptureDevice() = default;

  /// Finds the camera, opens it and sets it up. May take seconds. Called again after close() to reconnect;
  /// then only the same camera is accepted, so that an unplugged endoscope is never replaced by the laptop's
  /// own camera.
  virtual Result<OpenedDevice> open() = 0;
  virtual void close() = 0;

  /// Waits about 50 ms at most. `stamp` is the driver's time of the picture on CLOCK_MONOTONIC, 0 when it
  /// gives none. `unreadable`: this picture only. Any other error: the camera is gone.
  virtual Result<Pull> read(cv::Mat& bgr, Nanoseconds& stamp) = 0;

  /// Refused values are an error that says what the camera has instead.
  virtual Result<void> set_exposure(double milliseconds) = 0;
  virtual Result<void> set_gain(double gain) = 0;

  /// Exposure time that the camera has now, ms; 0: it does not say, or sets it itself.
  virtual double exposure_ms() const { return 0; }
};

}  // namespace linescope
