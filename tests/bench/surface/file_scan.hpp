// A scan from a file (tools/studies/surface_scan_file.hpp) as the phantoms' scans look.
#pragma once

#include <filesystem>

#include "common/result.hpp"
#include "tests/unit/surface/surface_phantom.hpp"

namespace linescope::bench {

/// The plan's length and width are those of what was seen.
Result<testing::CondyleScan> scan_from_file(const std::filesystem::path& file);

}  // namespace linescope::bench
