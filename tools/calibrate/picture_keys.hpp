// How many pictures a step takes from a recording or a living camera: the keys that camera, laser and
// hand-eye have in common.
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

}  // namespace linescope::calibrate
