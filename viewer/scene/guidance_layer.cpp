#include "viewer/scene/guidance_layer.hpp"

#include <vtkArrowSource.h>
#include <vtkCylinderSource.h>
#include <vtkMatrix4x4.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkSphereSource.h>

#include <Eigen/Geometry>
#include <utility>

#include "viewer/scene/palette.hpp"

namespace linescope {
namespace {

// Of the harvester as drawn, mm: an 8 mm chisel is what the thesis's operation uses.
constexpr double kTubeRadius = 4.0, kTubeLength = 60.0, kTipRadius = 1.0;
constexpr double kConeLength = 6.0;  ///< tube begins that far behind the tip, so that the tip can be seen
constexpr double kArrowLength = 30.0;
constexpr double kAxisAhead = 15.0;  ///< the axis is drawn through the tip, towards the surface
constexpr double kGhost = 0.3, kSeeThrough = 0.25;
constexpr double kTubePresent = 0.45, kTubeGhost = 0.15;  ///< what lies behind the tube matters more than it

/// Puts +x of the source along `direction` with its origin at `origin`.
vtkSmartPointer<vtkMatrix4x4> placement(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                        double length, double width) {
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), direction);
  Eigen::Matrix3d linear = turn.toRotationMatrix();
  linear.col(0) *= length;
  linear.col(1) *= width;
  linear.col(2) *= width;
  auto matrix = vtkSmartPointer<vtkMatrix4x4>::New();
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) matrix->SetElement(r, c, linear(r, c));
    matrix->SetElement(r, 3, origin[r]);
  }
  return matrix;
}

template <class Source>
void give(vtkActor& actor, Source& source, const Rgb& colour) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(source.GetOutputPort());
  actor.SetMapper(mapper);
  actor.GetProperty()->SetColor(colour[0], colour[1], colour[2]);
  actor.GetProperty()->SetAmbient(0.25);
  actor.PickableOff();
  actor.VisibilityOff();
}

/// A unit cylinder along +x from the origin to 1, radius 1.
void give_rod(vtkActor& actor, const Rgb& colour) {
  vtkNew<vtkArrowSource> rod;  // its shaft alone, as long as the whole
  rod->SetTipLength(0.0);
  rod->SetTipRadius(0.0);
  rod->SetShaftRadius(1.0);
  rod->SetShaftResolution(32);
  give(actor, *rod, colour);
}

}  // namespace

GuidanceLayer::GuidanceLayer(const std::function<void(vtkProp*)>& add_actor,
                             const std::function<void(vtkProp*)>& add_tube) {
  give_rod(*tube_, palette::kHarvester);
  give_rod(*axis_line_, palette::kHarvester);
  vtkNew<vtkSphereSource> ball;
  ball->SetRadius(1.0);
  ball->SetThetaResolution(24);
  ball->SetPhiResolution(16);
  give(*tip_, *ball, palette::kTip);
  give(*foot_, *ball, palette::kNormal);
  vtkNew<vtkArrowSource> arrow;
  arrow->SetTipLength(0.25);
  arrow->SetTipRadius(1.0);
  arrow->SetShaftRadius(0.4);
  arrow->SetTipResolution(24);
  arrow->SetShaftResolution(16);
  give(*arrow_, *arrow, palette::kNormal);
  arrow_->GetProperty()->SetAmbient(0.6);  // looked at along its axis it would be dark
  arrow_->GetProperty()->SetDiffuse(0.4);
  add_tube(tube_);
  for (vtkActor* actor : {tip_.Get(), axis_line_.Get(), arrow_.Get(), foot_.Get()}) add_actor(actor);
}

void GuidanceLayer::set(const GuidanceInput& input) {
  set_harvester(input);
  set_normal(input);
  dirty_ = true;
}

void GuidanceLayer::set_harvester(const GuidanceInput& input) {
  const bool visible = input.harvester != Presence::absent;
  for (vtkActor* actor : {tube_.Get(), tip_.Get(), axis_line_.Get()}) {
    actor->SetVisibility(visible);
    actor->GetProperty()->SetOpacity(input.harvester == Presence::ghost ? kGhost : 1.0);
  }
  if (!visible) return;
  const bool present = input.harvester == Presence::present;
  tube_->GetProperty()->SetOpacity(!present ? kTubeGhost : see_through_ ? kSeeThrough : kTubePresent);
  const Rgb& colour = input.on_target ? palette::kOnTarget : palette::kHarvester;
  tube_->GetProperty()->SetColor(colour[0], colour[1], colour[2]);
  tube_->SetUserMatrix(placement(input.tip + kConeLength * input.axis, input.axis, kTubeLength, kTubeRadius));
  axis_line_->SetUserMatrix(placement(input.tip - kAxisAhead * input.axis, input.axis,
                                      kAxisAhead + kConeLength + kTubeLength, 0.25));
  tip_->SetUserMatrix(placement(input.tip, input.axis, kTipRadius, kTipRadius));
}

void GuidanceLayer::set_normal(const GuidanceInput& input) {
  arrow_->SetVisibility(input.normal);
  foot_->SetVisibility(input.normal);
  if (!input.normal) return;
  arrow_->SetUserMatrix(placement(input.foot, input.normal_direction, kArrowLength, 1.6));
  foot_->SetUserMatrix(placement(input.foot, input.normal_direction, 0.8, 0.8));
}

bool GuidanceLayer::harvester_ghosted() const {
  return harvester_visible() && tip_->GetProperty()->GetOpacity() < 1.0;
}

}  // namespace linescope
