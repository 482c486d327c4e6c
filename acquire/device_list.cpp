#include "acquire/device_list.hpp"

#include <fmt/format.h>

namespace linescope {
namespace {

std::string line(const char* kind, const std::string& where, const std::string& what,
                 const std::string& verdict) {
  return fmt::format("{:<8}{}  {}  {}\n", kind, where, what, verdict);
}

std::string verdict(const TrackerFinding& tracker) {
  if (tracker.obstacle) return tracker.obstacle->message;
  if (tracker.what == "serial line") return "free; whether a LIBERTY is at its end shows when it is started";
  return "usable";
}

}  // namespace

std::string list_text(const std::vector<CameraInfo>& cameras,
                      const Result<std::vector<TrackerFinding>>& trackers) {
  std::string text;
  for (const CameraInfo& camera : cameras)
    text += line("camera", camera.path, camera.name, camera.usable() ? "usable" : camera.obstacle);
  if (cameras.empty()) text += "camera  none: this machine has no /dev/video*; plug one in\n";
  if (!trackers) return text + "tracker none: " + trackers.error().message + "\n";
  for (const TrackerFinding& tracker : *trackers)
    text += line("tracker", tracker.where, tracker.what, verdict(tracker));
  if (trackers->empty())
    text +=
        "tracker none: no LIBERTY on USB (0f44:ff20) and no serial line; switch it on and plug it in "
        "(docs/liberty.md)\n";
  return text;
}

}  // namespace linescope
