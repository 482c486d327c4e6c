// The video nodes of this machine, and the reason why one cannot be used: for `--list` and for choosing.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/result.hpp"

namespace linescope {

struct CameraInfo {
  std::string path;      ///< "/dev/video0"
  std::string name;      ///< as the driver calls it
  std::string obstacle;  ///< one sentence why it cannot be used and what to do; empty when it can

  bool usable() const { return obstacle.empty(); }
};

/// All video nodes in natural order. Opens each for a moment and asks for one buffer, which the kernel
/// refuses where somebody else captures: a running capture is not disturbed.
/// @param sysfs  folder with one entry per node; another one only in tests
/// @param dev    folder of the nodes themselves
std::vector<CameraInfo> list_cameras(const std::filesystem::path& sysfs = "/sys/class/video4linux",
                                     const std::filesystem::path& dev = "/dev");

/// The camera that `choice` means: a path ("/dev/video2"), an index ("2"), a part of the name, or empty for
/// the first usable one. not_found: one sentence with what there is instead; busy, permission, unsupported:
/// its obstacle.
Result<CameraInfo> choose_camera(const std::string& choice, const std::vector<CameraInfo>& cameras);

/// What an error number of opening a node or asking it for a buffer means for people.
std::string obstacle_from_errno(const std::string& path, int error);

}  // namespace linescope
