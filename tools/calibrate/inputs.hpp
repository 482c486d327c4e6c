// What lies in files: a folder of pictures, a recording of the daemon, a video, a list of poses.
#pragma once

#include <filesystem>

#include "tools/calibrate/session.hpp"

namespace linescope::calibrate {

/// A recording is recognised by its recording.toml; a folder of pictures takes its poses from poses.csv in it
/// or beside it (columns: docs/configuration.md); a CSV file gives poses only; any other file is read as a
/// video. The poses of a folder of pictures belong to the pictures' own instants. not_found: no such file or
/// folder.
Result<Input> input_from_path(const std::filesystem::path& path);

}  // namespace linescope::calibrate
