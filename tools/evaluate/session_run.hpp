// A whole session through the daemon's own run, as fast as it can be computed, and what a viewer then holds.
//
// Nothing here extracts, triangulates or places: sources go into acquire's Acquisition and run_stepped, lines
// come out of its segment and through the viewer's LinePlacer.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "acquire/acquire_options.hpp"
#include "acquire/record/recording_info.hpp"
#include "acquire/sources.hpp"
#include "ipc/segment_statistics.hpp"
#include "ipc/segment_types.hpp"
#include "viewer/view_state.hpp"

namespace linescope::evaluate {

struct SessionOptions {
  LineExtractorOptions laser;
  LineReconstructorOptions reconstruct;
  PoseHistoryOptions history;
  StationRoles roles;
  std::uint32_t lines = 2'000;        ///< room in the segment
  std::uint32_t pose_history = 4096;  ///< samples kept per station
};

/// Lines in the object's frame (without an object sensor: in the world's), world poses of the tools.
struct Session {
  HeldLines lines;
  std::array<std::vector<PoseSample>, kToolRoles> poses;  ///< by ToolRole
  std::vector<CounterValue> counters;                     ///< what was dropped and why

  std::size_t points() const;
  std::uint64_t count(Counter counter) const;
};

/// The roles a recording was made with.
StationRoles roles_of(const RecordingInfo& info);

/// A recorded session's pictures and poses through the same run.
Result<Session> run_recording(const std::filesystem::path& folder, const StationRoles& roles,
                              const SessionOptions& algorithms);

/// `sources` are started and stepped. The segment it uses is gone afterwards. Any number of threads may run
/// sessions at the same time.
Result<Session> run_session(Sources sources, const SessionOptions& options);

}  // namespace linescope::evaluate
