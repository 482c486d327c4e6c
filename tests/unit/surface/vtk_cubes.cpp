#include "tests/unit/surface/vtk_cubes.hpp"

#include <vtkCellArray.h>
#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkMarchingCubes.h>
#include <vtkNew.h>
#include <vtkPolyData.h>

#include <algorithm>

namespace linescope::testing {
namespace {

TriangleMesh mesh_from(vtkPolyData& data) {
  TriangleMesh mesh;
  for (vtkIdType i = 0; i < data.GetNumberOfPoints(); ++i) {
    const double* p = data.GetPoint(i);
    mesh.positions.emplace_back(static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2]));
  }
  vtkIdType count = 0;
  const vtkIdType* ids = nullptr;
  for (data.GetPolys()->InitTraversal(); data.GetPolys()->GetNextCell(count, ids);)
    mesh.triangles.push_back({static_cast<std::uint32_t>(ids[0]), static_cast<std::uint32_t>(ids[1]),
                              static_cast<std::uint32_t>(ids[2])});
  return mesh;
}

template <class Filter>
TriangleMesh surface(vtkImageData& image) {
  vtkNew<Filter> filter;
  filter->SetInputData(&image);
  filter->SetValue(0, 0.5);
  filter->ComputeNormalsOff();
  filter->ComputeGradientsOff();
  filter->Update();
  return mesh_from(*filter->GetOutput());
}

}  // namespace

TriangleMesh vtk_surface(const DenseGrid& grid, VtkFilter filter) {
  vtkNew<vtkImageData> image;
  image->SetDimensions(grid.size.data());
  image->AllocateScalars(VTK_FLOAT, 1);
  std::copy(grid.marked.begin(), grid.marked.end(), static_cast<float*>(image->GetScalarPointer()));
  return filter == VtkFilter::marching_cubes ? surface<vtkMarchingCubes>(*image)
                                             : surface<vtkFlyingEdges3D>(*image);
}

}  // namespace linescope::testing
