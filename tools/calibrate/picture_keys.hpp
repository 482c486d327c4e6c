// Keys that steps with pictures have in common: how many are taken from a recording or a living camera
// (camera, laser, hand-eye), and what the laser's line looks like in them (laser, check).
#pragma once

#include <string>

#include "common/config_schema.hpp"
#include "tools/calibrate/session.hpp"

namespace linescope::calibrate {

struct PictureKeys {
  double every_ms = 300;
  int most = 60;

  /// `section`.every_ms and `section`.most_pictures, the latter at least `fewest`.
  void declare(ConfigSchema& schema, const std::string& section, int fewest, const std::string& enough);
  /// Pictures of the board, at most so many.
  CollectOptions wants(const BoardOptions& board) const;
};

/// The line in the picture. Everything else about finding it is as in the daemon by default.
struct LineKeys {
  LineExtractorOptions line;

  /// `section`.colour and `section`.axis.
  void declare(ConfigSchema& schema, const std::string& section);
};

}  // namespace linescope::calibrate
