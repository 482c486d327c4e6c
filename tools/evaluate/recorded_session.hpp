// A recorded session in place of the twin: the same run, judged without a truth by the shape that was
// scanned.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "common/result.hpp"
#include "tools/evaluate/report.hpp"

namespace linescope::evaluate {

/// What was scanned, as far as the user says.
struct KnownShape {
  enum class Kind { unknown, plane, cylinder } kind = Kind::unknown;
  double diameter_mm = 0;  ///< of the cylinder
};

/// "", "plane", "cylinder-49.1" (any diameter in mm).
Result<KnownShape> known_shape(const std::string& name);

/// Fails with one sentence when the recording cannot be read or holds no line.
Result<Report> evaluate_recording(const std::filesystem::path& folder, const KnownShape& shape);

}  // namespace linescope::evaluate
