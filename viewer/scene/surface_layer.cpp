#include "viewer/scene/surface_layer.hpp"

#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkIdTypeArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkProperty.h>

#include <cstring>
#include <numeric>

#include "viewer/scene/palette.hpp"

namespace linescope {
namespace {

void set_colour(vtkProperty& property, const Rgb& c) {
  property.SetColor(c[0], c[1], c[2]);
}

static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float), "copied as plain floats");

vtkSmartPointer<vtkFloatArray> float_array(const std::vector<Eigen::Vector3f>& values) {
  auto array = vtkSmartPointer<vtkFloatArray>::New();
  array->SetNumberOfComponents(3);
  array->SetNumberOfTuples(static_cast<vtkIdType>(values.size()));
  if (!values.empty())
    std::memcpy(array->GetPointer(0), values.data(), values.size() * sizeof(Eigen::Vector3f));
  return array;
}

/// Triangles of one origin; a mesh that names none was measured.
vtkSmartPointer<vtkCellArray> triangle_cells(const TriangleMesh& mesh, TriangleOrigin origin) {
  vtkNew<vtkIdTypeArray> offsets, corners;
  const auto all = static_cast<vtkIdType>(mesh.triangles.size());
  offsets->Allocate(all + 1);
  corners->Allocate(3 * all);
  offsets->InsertNextValue(0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if ((t < mesh.origin.size() ? mesh.origin[t] : TriangleOrigin::measured) != origin) continue;
    for (const std::uint32_t corner : mesh.triangles[t]) corners->InsertNextValue(corner);
    offsets->InsertNextValue(corners->GetNumberOfValues());
  }
  auto cells = vtkSmartPointer<vtkCellArray>::New();
  cells->SetData(offsets, corners);
  return cells;
}

vtkSmartPointer<vtkPoints> points_of(const std::vector<Eigen::Vector3f>& positions) {
  auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetData(float_array(positions));
  return points;
}

}  // namespace

SurfaceLayer::SurfaceLayer(const std::function<void(vtkProp*)>& add_actor) {
  mapper_->SetInputData(data_);
  mapper_->SetLookupTable(scale_);
  mapper_->UseLookupTableScalarRangeOn();
  actor_->SetMapper(mapper_);
  vtkProperty& front = *actor_->GetProperty();
  set_colour(front, palette::kSurface);
  front.SetAmbient(0.15);
  front.SetDiffuse(0.85);
  front.SetSpecular(0.15);
  front.SetSpecularPower(20);
  vtkNew<vtkProperty> back;
  set_colour(*back, palette::kInside);
  actor_->SetBackfaceProperty(back);
  filled_mapper_->SetInputData(filled_data_);
  filled_mapper_->ScalarVisibilityOff();
  filled_actor_->SetMapper(filled_mapper_);
  set_colour(*filled_actor_->GetProperty(), palette::kFilled);
  grid_mapper_->SetInputData(grid_data_);
  grid_mapper_->ScalarVisibilityOff();
  grid_actor_->SetMapper(grid_mapper_);
  set_colour(*grid_actor_->GetProperty(), palette::kGrid);
  grid_actor_->GetProperty()->SetPointSize(4);
  grid_actor_->GetProperty()->LightingOff();
  grid_actor_->VisibilityOff();
  add_actor(actor_);
  add_actor(filled_actor_);
  add_actor(grid_actor_);
}

void SurfaceLayer::set(const SurfaceView& view) {
  mesh_ = view.mesh;
  grid_ = view.grid;
  new_data_ = dirty_ = true;
}

void SurfaceLayer::show(SurfaceStyle style) {
  for (vtkActor* actor : {actor_.Get(), filled_actor_.Get()}) {
    actor->SetVisibility(style != SurfaceStyle::hidden);
    if (style == SurfaceStyle::wireframe)
      actor->GetProperty()->SetRepresentationToWireframe();
    else
      actor->GetProperty()->SetRepresentationToSurface();
  }
  dirty_ = true;
}

void SurfaceLayer::show_grid(bool visible) {
  grid_actor_->SetVisibility(visible);
  dirty_ = true;
}

void SurfaceLayer::use_normals(bool smooth) {
  for (vtkActor* actor : {actor_.Get(), filled_actor_.Get()}) {
    if (smooth)
      actor->GetProperty()->SetInterpolationToPhong();
    else
      actor->GetProperty()->SetInterpolationToFlat();
  }
  dirty_ = true;
}

void SurfaceLayer::colour_by(ColourBy what, const Eigen::Vector3d& outward) {
  colour_ = what == ColourBy::age ? ColourBy::plain : what;
  outward_ = outward;
  new_data_ = dirty_ = true;
}

void SurfaceLayer::fill_mesh() {
  triangles_ = mesh_ ? mesh_->triangle_count() : 0;
  filled_ = 0;
  if (!mesh_) {
    filled_data_->Initialize();
    return data_->Initialize();
  }
  const auto points = points_of(mesh_->positions);
  const auto normals = float_array(mesh_->normals);
  for (const auto& [data, origin] :
       {std::pair{data_.Get(), TriangleOrigin::measured}, {filled_data_.Get(), TriangleOrigin::filled}}) {
    data->SetPoints(points);
    data->SetPolys(triangle_cells(*mesh_, origin));
    data->GetPointData()->SetNormals(normals);
  }
  filled_ = static_cast<std::size_t>(filled_data_->GetNumberOfPolys());
  fill_scalars();
}

void SurfaceLayer::fill_scalars() {
  mapper_->SetScalarVisibility(colour_ != ColourBy::plain);
  if (colour_ == ColourBy::plain) return;
  std::vector<float> values;
  values.reserve(mesh_->vertex_count());
  for (std::size_t i = 0; i < mesh_->vertex_count(); ++i) {
    if (colour_ == ColourBy::height)
      values.push_back(mesh_->positions[i].dot(outward_.cast<float>()));
    else if (colour_ == ColourBy::uncertainty)
      values.push_back(mesh_->uncertainty[i]);
    else
      values.push_back(static_cast<float>(mesh_->observations[i]));
  }
  vtkNew<vtkFloatArray> array;
  array->SetNumberOfTuples(static_cast<vtkIdType>(values.size()));
  if (!values.empty()) std::memcpy(array->GetPointer(0), values.data(), values.size() * sizeof(float));
  data_->GetPointData()->SetScalars(array);
  const auto [low, high] = colour_range(values);
  scale_->SetTableRange(low, high);
}

void SurfaceLayer::fill_grid() {
  grid_count_ = grid_ ? grid_->size() : 0;
  grid_data_->Initialize();
  if (grid_count_ == 0) return;
  grid_data_->SetPoints(points_of(*grid_));
  std::vector<vtkIdType> ids(grid_count_);
  std::iota(ids.begin(), ids.end(), vtkIdType{0});
  vtkNew<vtkCellArray> cells;
  cells->InsertNextCell(static_cast<vtkIdType>(ids.size()), ids.data());
  grid_data_->SetVerts(cells);
}

bool SurfaceLayer::refresh() {
  if (std::exchange(new_data_, false)) {
    fill_mesh();
    fill_grid();
  }
  return std::exchange(dirty_, false);
}

}  // namespace linescope
