// From one word of the configuration to a source of pictures.
#pragma once

#include <memory>
#include <string>

#include "acquire/camera/camera_source.hpp"
#include "acquire/camera/device_camera.hpp"

namespace linescope {

struct CameraOptions {
  /// A folder of pictures, a video file, or a camera (path, index, part of the name; empty: the first usable
  /// camera).
  std::string source;
  DeviceCameraOptions device;  ///< for cameras; its field `device` is taken from `source`
  Nanoseconds start_time = 0;  ///< of the first picture, for files
  Nanoseconds period = 0;      ///< between two pictures of files; 0: the video's own, 40 ms for a folder
  int width = 0;               ///< px expected of files; 0: any
  int height = 0;              ///< px expected of files; 0: any
};

/// The source, not yet started. Fails only when `source` looks like a file or folder that does not exist.
Result<std::unique_ptr<CameraSource>> make_camera(const CameraOptions& options);

}  // namespace linescope
