// From one word of the configuration to a source of pictures.
#pragma once

#include <memory>
#include <string>

#include "acquire/camera/camera_source.hpp"
#include "acquire/camera/v4l2_device.hpp"

namespace linescope {

struct CameraOptions {
  /// A folder of pictures, a video file, or a camera (path, index, part of the name; empty: the first usable
  /// camera).
  std::string source = {};
  V4l2Options device = {};     ///< for cameras; its field `device` is taken from `source`
  Nanoseconds start_time = 0;  ///< of the first picture, for files
  Nanoseconds period = 0;      ///< between two pictures of files; 0: the video's own, 40 ms for a folder
  int width = 0;               ///< px expected of files; 0: any
  int height = 0;              ///< px expected of files; 0: any
};

enum class CameraKind { folder, video, device };

/// What `source` means. Existing folders and files win; what looks like a path or a video but does not exist
/// is not_found; everything else is a camera.
Result<CameraKind> kind_of_camera(const std::string& source);

/// The source, not yet started. Options of the wrong range and sources that do not exist fail here.
Result<std::unique_ptr<CameraSource>> make_camera(const CameraOptions& options);

}  // namespace linescope
