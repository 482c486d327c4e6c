// What the window remembers from one run to the next, beside the options of the command line.
#pragma once

#include "viewer/panel/evaluation_box.hpp"
#include "viewer/readouts.hpp"
#include "viewer/scene/colour_scale.hpp"
#include "viewer/scene/scene.hpp"

namespace linescope {

struct WindowPreferences {
  ViewLayout layout = ViewLayout::one;
  ColourBy colour = ColourBy::plain;
  bool smooth = true;    ///< shaded with the surface normals
  bool flipped = false;  ///< the view along the harvester
  Tolerance tolerance;
  bool sound = false;
  EvaluationRequest evaluation;  ///< its region: the radius only
};

}  // namespace linescope
