// What the steps calibrate from: the board corners and the laser line of every picture, and the tracker's
// poses. Pictures themselves are not kept, so that a recording of minutes fits into memory.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "acquire/camera/camera_source.hpp"
#include "acquire/laser/extracted_line.hpp"
#include "acquire/tracker/pose_history.hpp"
#include "acquire/tracker/tracker_source.hpp"
#include "common/calibration.hpp"
#include "tools/calibrate/board.hpp"
#include "tools/calibrate/verdict.hpp"

namespace linescope::calibrate {

/// What one picture gave.
struct Observation {
  std::string name;              ///< file name, or "picture 17"
  Nanoseconds time = 0;          ///< time stamp as the source gave it: the camera's latency is not taken off
  BoardView board;               ///< empty: not found or not looked for
  std::vector<LineSample> line;  ///< empty: not found or not looked for
};

/// Which tracker station sits where; 0-based, -1: none.
struct Stations {
  int endoscope = 0;
  int object = 1;
  int harvester = 2;
};

/// Where pictures and poses come from: folder and poses.csv, recording, segment, twin.
struct Input {
  std::unique_ptr<CameraSource> camera;    ///< may be null: poses only
  std::unique_ptr<TrackerSource> tracker;  ///< may be null: pictures only
  Stations stations;
  std::optional<Calibration> calibration;  ///< what the source was recorded with
  std::string description;                 ///< for people and for the stored result
};

struct CollectOptions {
  std::optional<BoardOptions> board;         ///< look for this board
  std::optional<LineExtractorOptions> line;  ///< look for the laser line
  Nanoseconds every = 0;  ///< pictures closer in time to the last one looked at are passed over; 0: all
  std::size_t most_pictures = 0;  ///< stop after so many pictures with what was looked for; 0: no limit
  bool poses_only = false;        ///< no picture is asked for, so that a camera may be missing
  std::size_t most_poses = 0;     ///< poses_only: stop after so many of the harvester's station; 0: no limit
  Nanoseconds longest = 0;        ///< live: stop after this time; 0: no limit
};

struct Session {
  int width = 0;                          ///< px, the same for all pictures
  int height = 0;                         ///< px
  std::vector<Observation> observations;  ///< in time order: those in which something was found
  std::vector<LeftOut> left_out;          ///< pictures in which nothing was found, or that cannot be read
  std::size_t mirrored = 0;               ///< of them: a board with markers, seen in a mirror
  std::size_t offered = 0;                ///< pictures looked at
  std::array<std::vector<PoseSample>, kMaxStations> poses;  ///< per station in time order
  Stations stations;
  std::optional<Calibration> calibration;
  std::string description;
  std::uint64_t hash = 0;  ///< of every pixel and pose that was looked at

  /// Pose of a station at the true instant of a picture: time stamp less `latency`. Interpolated between the
  /// samples on both sides, never extrapolated, over gaps of at most `longest_gap`.
  PoseAnswer pose_at(int station, Nanoseconds time, Nanoseconds latency = 0,
                     Nanoseconds longest_gap = 50 * kMillisecond) const;
};

/// What is there after each picture, for the live display.
using Progress = std::function<bool(const Session& so_far, const Frame& picture)>;

/// Runs through the input. Stops at its end, at a limit of `options`, or when `progress` returns false.
/// Fails with `mismatch` on pictures of mixed sizes, with the source's own error when it breaks off, and with
/// `not_found` when there was no picture and no pose at all.
Result<Session> collect(Input& input, const CollectOptions& options, const Progress& progress = {});

}  // namespace linescope::calibrate
