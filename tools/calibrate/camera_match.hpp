// A calibrated camera belongs to one picture size.
#pragma once

#include <fmt/format.h>

#include "common/camera_model.hpp"
#include "tools/calibrate/session.hpp"

namespace linescope::calibrate {

/// Fails with `mismatch` when the pictures have another size than that at which `camera` was calibrated.
inline Result<void> fits_camera(const Session& session, const CameraModel& camera) {
  if (session.width == camera.width && session.height == camera.height) return {};
  return fail(
      ErrorCode::mismatch,
      fmt::format("the pictures are {}x{}, the camera was calibrated at {}x{}: run the camera step first",
                  session.width, session.height, camera.width, camera.height));
}

}  // namespace linescope::calibrate
