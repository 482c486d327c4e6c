// --list: what is plugged in, and why something cannot be used.
#pragma once

#include <string>
#include <vector>

#include "acquire/camera/camera_list.hpp"
#include "acquire/tracker/liberty/find_trackers.hpp"

namespace linescope {

/// One line per camera and per tracker: kind, place, name, "usable" or the reason with what to do about it.
/// `trackers` may be an error: USB cannot be used at all.
std::string list_text(const std::vector<CameraInfo>& cameras,
                      const Result<std::vector<TrackerFinding>>& trackers);

}  // namespace linescope
