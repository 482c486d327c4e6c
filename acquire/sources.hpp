// The camera, the tracker and the calibration that the options ask for, put together.
#pragma once

#include <memory>
#include <string>

#include "acquire/acquire_options.hpp"
#include "acquire/camera/camera_source.hpp"
#include "acquire/tracker/tracker_source.hpp"
#include "common/calibration.hpp"
#include "common/exit_code.hpp"

namespace linescope {

struct Sources {
  std::unique_ptr<CameraSource> camera;
  std::unique_ptr<TrackerSource> tracker;  ///< null: "none"
  Calibration calibration;
  bool live = false;  ///< true: at least one source delivers what happens now
};

/// Builds and starts them. Stepped sources get times that begin at `start`. A failure says which part and
/// why, and how the program ends. The twin's truth is written here when it is asked for.
tl::expected<Sources, Refusal> make_sources(const AcquireOptions& options, Nanoseconds start);

}  // namespace linescope
