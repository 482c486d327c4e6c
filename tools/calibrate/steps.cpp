#include "tools/calibrate/check_step.hpp"
#include "tools/calibrate/harvester_step.hpp"
#include "tools/calibrate/optical_steps.hpp"
#include "tools/calibrate/step.hpp"
#include "tools/calibrate/time_step.hpp"

namespace linescope::calibrate {

std::vector<std::unique_ptr<Step>> all_steps() {
  std::vector<std::unique_ptr<Step>> steps;
  steps.push_back(make_camera_step());
  steps.push_back(make_laser_step());
  steps.push_back(make_hand_eye_step());
  steps.push_back(std::make_unique<HarvesterStep>());
  steps.push_back(std::make_unique<TimeStep>());
  steps.push_back(std::make_unique<CheckStep>());
  return steps;
}

}  // namespace linescope::calibrate
