#include "viewer/line_placer.hpp"

#include <algorithm>

namespace linescope {
namespace {

Rigid<Held, World> held_from_world(const Line& line, HeldIn held_in) {
  if (held_in == HeldIn::world) return {};
  return renamed<Held, World>(line.object.world_from_tool.inverse());
}

}  // namespace

Rigid<World, CameraCv> LinePlacer::world_from_camera(const Line& line) const {
  return line.endoscope.world_from_tool * endoscope_from_camera_;
}

tl::expected<std::shared_ptr<const HeldLine>, ToolState> LinePlacer::place(
    const Line& line, std::span<const SurfacePoint> world_points) const {
  if (held_in_ == HeldIn::object && !usable(line.object.state)) return tl::unexpected(line.object.state);
  const Rigid<Held, World> held = held_from_world(line, held_in_);
  auto placed = std::make_shared<HeldLine>();
  placed->serial = line.serial;
  placed->time = line.time;
  placed->seen_from = held * world_from_camera(line).translation();
  placed->points.reserve(world_points.size());
  const Eigen::Matrix3f turn = held.rotation().toRotationMatrix().cast<float>();
  const Eigen::Vector3f shift = held.translation().cast<float>();
  for (const SurfacePoint& p : world_points)
    placed->points.push_back({turn * p.position + shift, p.intensity, p.standard_deviation});
  return placed;
}

double LinePlacer::gap(const Line& line, std::span<const SurfacePoint> world_points) const {
  if (world_points.empty()) return 0;
  const Rigid<CameraCv, World> camera_from_world = world_from_camera(line).inverse();
  std::vector<double> depth;
  depth.reserve(world_points.size());
  for (const SurfacePoint& p : world_points)
    depth.push_back((camera_from_world * p.position.cast<double>()).z());
  const auto middle = depth.begin() + static_cast<std::ptrdiff_t>(depth.size() / 2);
  std::nth_element(depth.begin(), middle, depth.end());
  return *middle;
}

}  // namespace linescope
