#include <pcl/common/common.h>
#include <pcl/features/normal_3d.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>
#include <pcl/surface/gp3.h>
#include <pcl/surface/marching_cubes_hoppe.h>
#include <pcl/surface/poisson.h>

#include <cmath>
#include <memory>

#include "tests/bench/surface/peers.hpp"

namespace linescope::bench {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using Oriented = pcl::PointCloud<pcl::PointNormal>;

struct PclInput {
  Cloud::Ptr cloud{new Cloud};
  pcl::PointCloud<pcl::PointNormal> vertices;
  std::vector<pcl::Vertices> triangles;
};

Cloud::Ptr down_sampled(const PclInput& input, double leaf) {
  const auto side = static_cast<float>(leaf);
  pcl::VoxelGrid<pcl::PointXYZ> filter;
  filter.setInputCloud(input.cloud);
  filter.setLeafSize(side, side, side);
  Cloud::Ptr result(new Cloud);
  filter.filter(*result);
  return result;
}

Oriented::Ptr with_normals(const Cloud::Ptr& cloud, int neighbours) {
  pcl::NormalEstimation<pcl::PointXYZ, pcl::PointNormal> estimation;
  estimation.setInputCloud(cloud);
  estimation.setKSearch(neighbours);
  estimation.setViewPoint(0, 0, 1000);
  Oriented::Ptr result(new Oriented);
  estimation.compute(*result);
  for (std::size_t i = 0; i < cloud->size(); ++i)
    (*result)[i].getVector3fMap() = (*cloud)[i].getVector3fMap();
  return result;
}

void give_points(pcl::PCLSurfaceBase<pcl::PointNormal>& method, const Oriented::Ptr& points) {
  const pcl::search::KdTree<pcl::PointNormal>::Ptr tree(new pcl::search::KdTree<pcl::PointNormal>);
  tree->setInputCloud(points);
  method.setSearchMethod(tree);
  method.setInputCloud(points);
}

Eigen::Vector3f extent_of(const Oriented& points) {
  Eigen::Vector4f low, high;
  pcl::getMinMax3D(points, low, high);
  return (high - low).head<3>();
}

void hoppe(PclInput& input, double cell) {
  const Oriented::Ptr points = with_normals(down_sampled(input, cell / 2), 60);
  const Eigen::Array3i steps = (extent_of(*points).array() / static_cast<float>(cell)).ceil().cast<int>() + 2;
  pcl::MarchingCubesHoppe<pcl::PointNormal> method;
  method.setGridResolution(steps.x(), steps.y(), steps.z());
  method.setDistanceIgnore(static_cast<float>(cell));
  give_points(method, points);
  method.reconstruct(input.vertices, input.triangles);
}

void greedy(PclInput& input, double cell) {
  pcl::GreedyProjectionTriangulation<pcl::PointNormal> method;
  method.setSearchRadius(2 * cell);
  method.setMu(2.5);
  method.setMaximumNearestNeighbors(60);
  const Oriented::Ptr points = with_normals(down_sampled(input, cell / 2), 60);
  give_points(method, points);
  method.reconstruct(input.triangles);
  input.vertices = *points;
}

/// Depth of the octree at which its cells are about as wide as the interval.
int depth_for(const Oriented& points, double cell) {
  return static_cast<int>(std::ceil(std::log2(1.1 * extent_of(points).maxCoeff() / cell)));
}

void poisson(PclInput& input, double cell, bool all_points) {
  const Oriented::Ptr points =
      all_points ? with_normals(input.cloud, 100) : with_normals(down_sampled(input, cell / 2), 60);
  pcl::Poisson<pcl::PointNormal> method;
  method.setDepth(depth_for(*points, cell));
  give_points(method, points);
  method.reconstruct(input.vertices, input.triangles);
}

TriangleMesh mesh_from(const PclInput& input) {
  TriangleMesh mesh;
  for (const auto& p : input.vertices) mesh.positions.push_back(p.getVector3fMap());
  for (const auto& t : input.triangles)
    if (t.vertices.size() == 3)
      mesh.triangles.push_back({static_cast<std::uint32_t>(t.vertices[0]),
                                static_cast<std::uint32_t>(t.vertices[1]),
                                static_cast<std::uint32_t>(t.vertices[2])});
  return mesh;
}

}  // namespace

std::vector<Peer> pcl_peers(std::span<const Eigen::Vector3f> points, double cell) {
  const auto input = std::make_shared<PclInput>();
  for (const auto& p : points) input->cloud->push_back({p.x(), p.y(), p.z()});
  const auto mesh = [input] { return mesh_from(*input); };
  return {{"PCL VoxelGrid, normals, MarchingCubesHoppe", [=] { hoppe(*input, cell); }, mesh},
          {"PCL VoxelGrid, normals, GreedyProjection", [=] { greedy(*input, cell); }, mesh},
          {"PCL VoxelGrid, normals, Poisson", [=] { poisson(*input, cell, false); }, mesh, true},
          {"PCL all points, normals, Poisson", [=] { poisson(*input, cell, true); }, mesh, true}};
}

}  // namespace linescope::bench
