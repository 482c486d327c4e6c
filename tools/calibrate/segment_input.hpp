// Pictures and poses of a running daemon, live.
#pragma once

#include <string>

#include "tools/calibrate/session.hpp"

namespace linescope::calibrate {

/// Attaches read-only to the segment of that name: the daemon and its other readers notice nothing. Two
/// readers are made, one for pictures and one for poses. Ends with `gone` when the daemon falls silent, ends
/// or is replaced while data are collected.
Result<Input> input_from_segment(const std::string& name);

}  // namespace linescope::calibrate
