#include "viewer/scene/mark_layer.hpp"

#include <vtkCellArray.h>
#include <vtkPoints.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>

#include "viewer/scene/palette.hpp"

namespace linescope {
namespace {

void style(vtkActor& actor) {
  vtkProperty& p = *actor.GetProperty();
  p.SetColor(palette::kMeasure[0], palette::kMeasure[1], palette::kMeasure[2]);
  p.LightingOff();
  p.SetPointSize(9);
  p.SetLineWidth(2);
  actor.VisibilityOff();
  actor.PickableOff();
}

}  // namespace

MarkLayer::MarkLayer(const std::function<void(vtkProp*)>& add_actor) {
  vtkNew<vtkPolyDataMapper> ends_mapper, ball_mapper;
  ends_mapper->SetInputData(ends_data_);
  // In front of the surface it lies on.
  ends_mapper->SetRelativeCoincidentTopologyLineOffsetParameters(0, -66000);
  ends_mapper->SetRelativeCoincidentTopologyPointOffsetParameter(-66000);
  ends_mapper->SetResolveCoincidentTopologyToPolygonOffset();
  ends_->SetMapper(ends_mapper);
  style(*ends_);
  ball_source_->SetThetaResolution(24);
  ball_source_->SetPhiResolution(13);
  ball_mapper->SetInputConnection(ball_source_->GetOutputPort());
  ball_->SetMapper(ball_mapper);
  style(*ball_);
  ball_->GetProperty()->SetRepresentationToWireframe();
  ball_->GetProperty()->SetLineWidth(1);
  add_actor(ends_);
  add_actor(ball_);
}

void MarkLayer::set_distance(const std::vector<Eigen::Vector3d>& ends) {
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> dots, line;
  for (const Eigen::Vector3d& end : ends) {
    const vtkIdType id = points->InsertNextPoint(end.data());
    dots->InsertNextCell(1, &id);
  }
  if (ends.size() == 2) line->InsertNextCell({0, 1});
  ends_data_->SetPoints(points);
  ends_data_->SetVerts(dots);
  ends_data_->SetLines(line);
  ends_->SetVisibility(!ends.empty());
  dirty_ = true;
}

void MarkLayer::set_region(const std::optional<MarkedRegion>& region) {
  ball_->SetVisibility(region.has_value());
  dirty_ = true;
  if (!region) return;
  ball_source_->SetCenter(region->centre.x(), region->centre.y(), region->centre.z());
  ball_source_->SetRadius(region->radius);
}

}  // namespace linescope
