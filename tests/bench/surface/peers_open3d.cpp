#include <open3d/geometry/KDTreeSearchParam.h>
#include <open3d/geometry/PointCloud.h>
#include <open3d/geometry/RGBDImage.h>
#include <open3d/geometry/TriangleMesh.h>
#include <open3d/pipelines/integration/ScalableTSDFVolume.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "tests/bench/surface/peers.hpp"

namespace linescope::bench {
namespace {

using open3d::geometry::KDTreeSearchParamKNN;
using open3d::geometry::PointCloud;

struct Open3dInput {
  PointCloud cloud;
  std::shared_ptr<open3d::geometry::TriangleMesh> result;
};

void give_normals(PointCloud& cloud, int neighbours) {
  cloud.EstimateNormals(KDTreeSearchParamKNN(neighbours));
  cloud.OrientNormalsTowardsCameraLocation({0, 0, 1000});
}

void ball_pivoting(Open3dInput& input, double cell) {
  const auto cloud = input.cloud.VoxelDownSample(cell);
  give_normals(*cloud, 15);
  input.result =
      open3d::geometry::TriangleMesh::CreateFromPointCloudBallPivoting(*cloud, {0.8 * cell, 1.6 * cell});
}

void poisson(Open3dInput& input, PointCloud& cloud, double cell, int neighbours) {
  give_normals(cloud, neighbours);
  const auto [mesh, densities] = open3d::geometry::TriangleMesh::CreateFromPointCloudPoisson(
      cloud, 0, static_cast<float>(cell), 1.1f, false, 1);
  input.result = mesh;
}

/// A depth picture of the points, from far above: the mean of what falls into a pixel.
struct DepthCamera {
  static constexpr double kDistance = 400;  ///< mm above the highest point
  static constexpr double kPixel = 0.25;    ///< mm
  open3d::camera::PinholeCameraIntrinsic intrinsic;
  Eigen::Matrix4d camera_from_points = Eigen::Matrix4d::Identity();
};

DepthCamera camera_over(const PointCloud& cloud) {
  const Eigen::Vector3d low = cloud.GetMinBound(), high = cloud.GetMaxBound();
  const Eigen::Vector2d extent = 1.05 * (high - low).head<2>();
  DepthCamera camera;
  const auto pixels = [](double mm) { return static_cast<int>(std::ceil(mm / DepthCamera::kPixel)); };
  const int width = pixels(extent.x()), height = pixels(extent.y());
  const double focal = DepthCamera::kDistance / DepthCamera::kPixel;
  camera.intrinsic.SetIntrinsics(width, height, focal, focal, 0.5 * (width - 1), 0.5 * (height - 1));
  camera.camera_from_points.diagonal() << 1, -1, -1, 1;
  camera.camera_from_points.col(3) << -0.5 * (low.x() + high.x()), 0.5 * (low.y() + high.y()),
      DepthCamera::kDistance + high.z(), 1;
  return camera;
}

open3d::geometry::Image depth_picture(const PointCloud& cloud, const DepthCamera& camera) {
  const int width = camera.intrinsic.width_, height = camera.intrinsic.height_;
  std::vector<float> sum(static_cast<std::size_t>(width * height)), count(sum.size());
  const auto [fx, fy] = camera.intrinsic.GetFocalLength();
  const auto [cx, cy] = camera.intrinsic.GetPrincipalPoint();
  for (const auto& point : cloud.points_) {
    const Eigen::Vector3d p = (camera.camera_from_points * point.homogeneous()).head<3>();
    const long u = std::lround(fx * p.x() / p.z() + cx), v = std::lround(fy * p.y() / p.z() + cy);
    if (u < 0 || v < 0 || u >= width || v >= height) continue;
    const auto at = static_cast<std::size_t>(v * width + u);
    sum[at] += static_cast<float>(p.z());
    count[at] += 1;
  }
  open3d::geometry::Image picture;
  picture.Prepare(width, height, 1, sizeof(float));
  for (int i = 0; i < width * height; ++i)
    *picture.PointerAt<float>(i % width, i / width) =
        sum[static_cast<std::size_t>(i)] / std::max(1.0f, count[static_cast<std::size_t>(i)]);
  return picture;
}

void truncated_distances(Open3dInput& input, double cell) {
  using namespace open3d::pipelines::integration;
  const DepthCamera camera = camera_over(input.cloud);
  open3d::geometry::RGBDImage picture;
  picture.depth_ = depth_picture(input.cloud, camera);
  picture.color_.Prepare(camera.intrinsic.width_, camera.intrinsic.height_, 1, sizeof(float));
  ScalableTSDFVolume volume(cell / 2, 3 * cell, TSDFVolumeColorType::Gray32);
  volume.Integrate(picture, camera.intrinsic, camera.camera_from_points);
  input.result = volume.ExtractTriangleMesh();
}

TriangleMesh mesh_from(const Open3dInput& input) {
  TriangleMesh mesh;
  for (const auto& p : input.result->vertices_) mesh.positions.push_back(p.cast<float>());
  for (const auto& t : input.result->triangles_)
    mesh.triangles.push_back({static_cast<std::uint32_t>(t[0]), static_cast<std::uint32_t>(t[1]),
                              static_cast<std::uint32_t>(t[2])});
  return mesh;
}

}  // namespace

std::vector<Peer> open3d_peers(std::span<const Eigen::Vector3f> points, double cell) {
  const auto input = std::make_shared<Open3dInput>();
  for (const auto& p : points) input->cloud.points_.push_back(p.cast<double>());
  const auto mesh = [input] { return mesh_from(*input); };
  const auto sampled = [=] { poisson(*input, *input->cloud.VoxelDownSample(cell / 2), cell, 60); };
  const auto all = [=] {
    PointCloud cloud = input->cloud;
    poisson(*input, cloud, cell, 100);
  };
  return {{"Open3D voxels, normals, ball pivoting", [=] { ball_pivoting(*input, cell); }, mesh},
          {"Open3D TSDF of a depth picture", [=] { truncated_distances(*input, cell); }, mesh},
          {"Open3D voxels, normals, Poisson", sampled, mesh, true},
          {"Open3D all points, normals, Poisson", all, mesh, true}};
}

}  // namespace linescope::bench
