// What the operator's hand does.
#pragma once

#include <string_view>

#include "common/result.hpp"

namespace linescope::twin {

enum class Scenario {
  demo,    ///< sweep the site, withdraw, harvester at the spots one after another; for ever
  sweeps,  ///< sweep the site to and fro; for ever
  spots,   ///< harvester at the spots one after another, the endoscope out of view; for ever
  still,   ///< the endoscope stands over the middle of the site, no tremor
  board,   ///< the endoscope looks at the board from many sides and stands still at each
  shake,   ///< the endoscope moves to and fro before the board
  pivot,   ///< the harvester swings about its tip
  spin,    ///< the harvester turns about its own axis
};

struct HandOptions {
  Scenario scenario = Scenario::demo;
  double sweep_seconds = 2.5;     ///< one way along the site (thesis: 1.5 .. 5)
  int sweeps = 4;                 ///< ways per scan, `demo` only
  double gap_mm = 15.0;           ///< mean distance camera - surface along the optical axis
  double gap_variation_mm = 3.0;  ///< slow, to both sides
  double tremor_mm = 0.10;        ///< 8 .. 12 Hz, amplitude per axis
  double tremor_rad = 0.002;
  double wander_mm = 0.6;  ///< 0.2 .. 0.9 Hz, amplitude per axis
  double wander_rad = 0.02;
  int spots = 5;                 ///< marked spots on the site
  double tilt_start_rad = 0.26;  ///< harvester against the normal when it arrives
  double tilt_end_rad = 0.005;   ///< and when the operator is satisfied
  double tilt_seconds = 4.0;
  double object_drift_mm = 0.0;  ///< slow movement of the object (sensor 2), amplitude
  double object_drift_rad = 0.0;
};

Result<Scenario> scenario_from_name(std::string_view name);
std::string_view name(Scenario scenario);

Result<void> validate(const HandOptions& options);

}  // namespace linescope::twin
