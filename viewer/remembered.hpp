// What one run of the viewer leaves to the next: size, text size, how surface and normal are made, layout,
// colours, tolerances. In the user's settings folder (linescope/viewer.ini).
#pragma once

#include "viewer/panel/window_preferences.hpp"
#include "viewer/viewer_options.hpp"

namespace linescope {

struct Remembered {
  ViewerOptions options;  ///< size, font_scale, mesher's method and interval, normal
  WindowPreferences window;
};

/// A value that cannot be is as if it were not there.
Remembered recall();
void remember(const Remembered& settings);

}  // namespace linescope
