#include "acquire/camera/camera_source.hpp"

#include <fmt/format.h>

namespace linescope {

std::string_view name(CameraState state) {
  switch (state) {
    case CameraState::not_started:
      return "not started";
    case CameraState::waiting:
      return "waiting";
    case CameraState::ok:
      return "ok";
    case CameraState::disconnected:
      return "disconnected";
    case CameraState::ended:
      return "ended";
  }
  return "unknown";
}

Result<void> CameraSource::set_exposure(double) {
  return fail(ErrorCode::unsupported, fmt::format("{} has no exposure that could be set", description()));
}

Result<void> CameraSource::set_gain(double) {
  return fail(ErrorCode::unsupported, fmt::format("{} has no gain that could be set", description()));
}

}  // namespace linescope
