// Where a view looks from: the thesis's form "CamePos" as numbers, and back from a camera moved with the
// mouse.
#pragma once

#include <vtkCamera.h>

#include <Eigen/Core>

namespace linescope {

/// About the held frame's axes. The camera sits at `target` + distance * (cos el cos az, cos el sin az, sin
/// el) and looks at `target`; at roll 0 the held frame's z points up on the screen.
struct ViewPose {
  double azimuth = 0;    ///< radians, (-pi, pi], about z from x
  double elevation = 0;  ///< radians, [-pi/2, pi/2]
  double roll = 0;       ///< radians, (-pi, pi], about the viewing direction, counter-clockwise on the screen
  double distance = 80;  ///< mm
  Eigen::Vector3d target{0, 0, 0};
};

void apply(const ViewPose& pose, vtkCamera& camera);
ViewPose view_pose_of(vtkCamera& camera);

/// The pose that looks along -`outward` with `up` (made perpendicular) upwards.
ViewPose looking_from(const Eigen::Vector3d& outward, const Eigen::Vector3d& up,
                      const Eigen::Vector3d& target, double distance);

}  // namespace linescope
