// The steps that calibrate from pictures of a board, as the program sees them.
#pragma once

#include "tools/calibrate/step.hpp"

namespace linescope::calibrate {

std::unique_ptr<Step> make_camera_step();
std::unique_ptr<Step> make_laser_step();
std::unique_ptr<Step> make_hand_eye_step();

}  // namespace linescope::calibrate
