#include "acquire/camera/no_camera.hpp"

#include <chrono>
#include <thread>

namespace linescope {

Result<Pull> NoCamera::next(Frame&) {
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  return Pull::nothing_yet;
}

CameraStatus NoCamera::status() const {
  CameraStatus status;
  status.reason = "no camera is used: poses only";
  return status;
}

}  // namespace linescope
