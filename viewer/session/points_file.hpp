// Lines and points of a session as two tables (points.csv, lines.csv) that every program reads.
#pragma once

#include <filesystem>
#include <fstream>

#include "common/result.hpp"
#include "viewer/background_job.hpp"
#include "viewer/view_state.hpp"

namespace linescope {

/// Millimetres with four decimals: a tenth of what the tracker resolves. `share`: this is the job's part from
/// share.first to share.second.
Result<void> write_points(const HeldLines& lines, const std::filesystem::path& folder, JobControl& control,
                          std::pair<double, double> share);

/// Refused with file and line: a row that is no row, a point of a line that lines.csv does not have, a
/// coordinate that is not finite.
Result<HeldLines> read_points(const std::filesystem::path& folder, JobControl& control,
                              std::pair<double, double> share);

/// What every file of a session ends with: all of it written, or a sentence.
Result<void> flushed(std::ofstream& out, const std::filesystem::path& file);
/// The answer of work that was cancelled.
tl::unexpected<Error> given_up();

}  // namespace linescope
