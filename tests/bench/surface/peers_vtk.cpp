#include <vtkCellArray.h>
#include <vtkContourFilter.h>
#include <vtkDelaunay2D.h>
#include <vtkExtractSurface.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPCANormalEstimation.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataAlgorithm.h>
#include <vtkSignedDistance.h>
#include <vtkSmartPointer.h>
#include <vtkSurfaceReconstructionFilter.h>
#include <vtkVoxelGrid.h>

#include <array>
#include <cmath>
#include <memory>

#include "tests/bench/surface/peers.hpp"

namespace linescope::bench {
namespace {

struct VtkInput {
  vtkNew<vtkPolyData> cloud;
  std::array<double, 6> bounds{};
  std::array<int, 3> dimensions{};
  vtkSmartPointer<vtkPolyData> result;
};

std::shared_ptr<VtkInput> input_from(std::span<const Eigen::Vector3f> points, double cell) {
  auto input = std::make_shared<VtkInput>();
  vtkNew<vtkPoints> places;
  for (const auto& p : points) places->InsertNextPoint(p.x(), p.y(), p.z());
  input->cloud->SetPoints(places);
  std::array<double, 6> tight{};
  input->cloud->GetBounds(tight.data());
  for (std::size_t i = 0; i < 3; ++i) {
    input->bounds[2 * i] = tight[2 * i] - 2 * cell;
    input->dimensions[i] =
        static_cast<int>(std::ceil((tight[2 * i + 1] + 2 * cell - input->bounds[2 * i]) / cell)) + 1;
    input->bounds[2 * i + 1] = input->bounds[2 * i] + (input->dimensions[i] - 1) * cell;
  }
  return input;
}

void configure(vtkVoxelGrid& filter, VtkInput& input, double leaf) {
  filter.SetInputData(input.cloud);
  filter.SetConfigurationStyleToLeafSize();
  filter.SetLeafSize(leaf, leaf, leaf);
}

/// Normals of the points that `source` gives, signed distances to them, triangles.
void reconstruct(VtkInput& input, vtkPolyDataAlgorithm* source, int neighbours, double cell) {
  vtkNew<vtkPCANormalEstimation> normals;
  if (source != nullptr)
    normals->SetInputConnection(source->GetOutputPort());
  else
    normals->SetInputData(input.cloud);
  normals->SetSampleSize(neighbours);
  normals->SetNormalOrientationToPoint();
  normals->SetOrientationPoint(0, 0, 1000);
  vtkNew<vtkSignedDistance> distance;
  distance->SetInputConnection(normals->GetOutputPort());
  distance->SetRadius(1.5 * cell);
  distance->SetBounds(input.bounds.data());
  distance->SetDimensions(input.dimensions.data());
  vtkNew<vtkExtractSurface> surface;
  surface->SetInputConnection(distance->GetOutputPort());
  surface->SetRadius(1.5 * cell * 0.99);
  surface->HoleFillingOff();
  surface->ComputeNormalsOff();
  surface->Update();
  input.result = surface->GetOutput();
}

void delaunay(VtkInput& input, double cell) {
  vtkNew<vtkVoxelGrid> voxels;
  configure(*voxels, input, cell / 2);
  vtkNew<vtkDelaunay2D> triangles;
  triangles->SetInputConnection(voxels->GetOutputPort());
  triangles->Update();
  input.result = triangles->GetOutput();
}

void surface_reconstruction(VtkInput& input, double cell) {
  vtkNew<vtkVoxelGrid> voxels;
  configure(*voxels, input, cell / 2);
  vtkNew<vtkSurfaceReconstructionFilter> distance;
  distance->SetInputConnection(voxels->GetOutputPort());
  distance->SetNeighborhoodSize(20);
  distance->SetSampleSpacing(cell);
  vtkNew<vtkContourFilter> contour;
  contour->SetInputConnection(distance->GetOutputPort());
  contour->SetValue(0, 0.0);
  contour->Update();
  input.result = contour->GetOutput();
}

TriangleMesh mesh_from(vtkPolyData& data) {
  TriangleMesh mesh;
  for (vtkIdType i = 0; i < data.GetNumberOfPoints(); ++i)
    mesh.positions.push_back(Eigen::Map<const Eigen::Vector3d>(data.GetPoint(i)).cast<float>());
  vtkIdType count = 0;
  const vtkIdType* ids = nullptr;
  for (data.GetPolys()->InitTraversal(); data.GetPolys()->GetNextCell(count, ids);)
    mesh.triangles.push_back({static_cast<std::uint32_t>(ids[0]), static_cast<std::uint32_t>(ids[1]),
                              static_cast<std::uint32_t>(ids[2])});
  return mesh;
}

}  // namespace

std::vector<Peer> vtk_peers(std::span<const Eigen::Vector3f> points, double cell) {
  const auto input = input_from(points, cell);
  const auto down_sample = [input, cell] {
    vtkNew<vtkVoxelGrid> voxels;
    configure(*voxels, *input, cell);
    voxels->Update();
  };
  const auto chain = [input, cell] {
    vtkNew<vtkVoxelGrid> voxels;
    configure(*voxels, *input, cell / 2);
    reconstruct(*input, voxels, 60, cell);
  };
  const auto mesh = [input] { return mesh_from(*input->result); };
  return {{"VTK VoxelGrid alone", down_sample, [] { return TriangleMesh{}; }},
          {"VTK VoxelGrid, PCANormals, SignedDistance, ExtractSurface", chain, mesh},
          {"VTK VoxelGrid, Delaunay2D", [=] { delaunay(*input, cell); }, mesh},
          {"VTK VoxelGrid, SurfaceReconstructionFilter, contour",
           [=] { surface_reconstruction(*input, cell); }, mesh, true},
          {"VTK all points, PCANormals, SignedDistance, ExtractSurface",
           [=] { reconstruct(*input, nullptr, 100, cell); }, mesh, true}};
}

}  // namespace linescope::bench
