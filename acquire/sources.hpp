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

  /// For people, when sources were only looked at: they are not started and cannot describe themselves.
  std::string camera_found;
  std::string tracker_found;
};

enum class Begin : std::uint8_t {
  start,  ///< sources run when they are handed over
  look,   ///< files are read, devices are only looked for and opened for a moment; nothing is written or sent
};

/// Builds and starts them. Stepped sources get times that begin at `start`. A failure says which part and
/// why, and how the program ends. The twin's truth is written here when it is asked for (Begin::start).
tl::expected<Sources, Refusal> make_sources(const AcquireOptions& options, Nanoseconds start,
                                            Begin begin = Begin::start);

}  // namespace linescope
