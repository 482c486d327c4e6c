// The one interface to pictures: a camera, a folder, a video file, a recording, the twin.
//
// Two kinds of sources exist. A *live* one (live() is true) delivers what happens now: next() waits at most
// 50 ms and then says `nothing_yet`. A *stepped* one (files, recordings, twin) returns its pictures at once,
// in time order, never sleeps and finishes with `end`: whoever uses it decides the pace.
//
// Threads: all calls on one source come from one thread at a time.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "acquire/pull.hpp"
#include "common/result.hpp"
#include "common/time.hpp"

namespace linescope {

/// One picture. Pass the same Frame to every call of next(): its memory is used again, so that nothing is
/// allocated per picture. Whoever keeps pixels beyond the next call clones them.
struct Frame {
  cv::Mat bgr;           ///< 8 bit, three channels, blue first
  Nanoseconds time = 0;  ///< the source's best knowledge of the middle of exposure, CLOCK_MONOTONIC. A
                         ///< device's constant offset is not in it: that is Calibration::camera_latency.
  std::uint64_t index =
      0;             ///< running number of the source, from 0; a jump means lost or unreadable pictures
  std::string name;  ///< file name for pictures from files, else empty
};

enum class CameraState : std::uint8_t {
  not_started,   ///< start() was not called or failed
  waiting,       ///< open, no picture yet
  ok,            ///< pictures come
  disconnected,  ///< a live camera that is gone; the source tries to find it again by itself
  ended,         ///< a stepped source has given its last picture
};

/// The word shown to people, for example "disconnected".
std::string_view name(CameraState state);

/// Everything that did not become a good picture, by reason.
struct CameraCounters {
  std::uint64_t delivered = 0;     ///< pictures given out by next()
  std::uint64_t unreadable = 0;    ///< broken file or broken picture of the stream
  std::uint64_t mismatched = 0;    ///< picture of another size than expected
  std::uint64_t late = 0;          ///< given out, but older than its period when it was
  std::uint64_t overrun = 0;       ///< came from the camera, but nobody fetched it in time
  std::uint64_t disconnected = 0;  ///< times the camera went away
};

struct CameraStatus {
  CameraState state = CameraState::not_started;
  std::string reason;      ///< one sentence when the state is not `ok`, for example why it is disconnected
  double exposure_ms = 0;  ///< what the camera says it has; 0: unknown, or its own automatic
  std::vector<std::string> remarks;  ///< what the camera did not accept, one sentence each
  CameraCounters counters;
};

class CameraSource {
 public:
  virtual ~CameraSource() = default;

  /// Opens the source. not_found, permission, busy, unreadable: one sentence that says what to do.
  virtual Result<void> start() = 0;

  /// The next picture. Errors with the code `unreadable` or `mismatch` concern one picture only: it is
  /// counted and the next call goes on after it. Any other error ends the source. After `end` the source
  /// keeps saying `end`.
  virtual Result<Pull> next(Frame& frame) = 0;

  virtual bool live() const = 0;

  /// For people, for example "folder frames, 12 pictures" or "USB camera /dev/video0, 640x480 at 30 Hz,
  /// MJPG".
  virtual std::string description() const = 0;

  virtual CameraStatus status() const = 0;

  /// Nominal time between two pictures; 0 when the source does not know it.
  virtual Nanoseconds period() const { return 0; }

  /// Exposure time in milliseconds, gain in the camera's own unit, while it runs. `unsupported` for anything
  /// that is not a camera with that control.
  virtual Result<void> set_exposure(double milliseconds);
  virtual Result<void> set_gain(double gain);
};

}  // namespace linescope
