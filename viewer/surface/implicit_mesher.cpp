#include "viewer/surface/implicit_mesher.hpp"

#include <algorithm>
#include <cmath>

#include "viewer/surface/point_gate.hpp"

namespace linescope {

ImplicitMesher::ImplicitMesher(const MesherOptions& options)
    : options_(options),
      sweeps_(options.sweep_pause),
      moments_(options),
      patches_(options),
      extractor_(options.interval) {}

void ImplicitMesher::add_line(const SurfaceLine& line) {
  const PointGate gate(options_, line);
  const bool usable =
      PointGate::admits_line(line) && std::any_of(line.points.begin(), line.points.end(),
                                                  [&](const SurfacePoint& p) { return gate.admits(p); });
  if (!usable) {
    if (PointGate::admits_line(line))
      for (const SurfacePoint& point : line.points) gate.count_refusal(point, counters_);
    ++counters_.lines_refused;
    return;
  }
  if (sweeps_.begins_with(line.time)) moments_.begin_sweep();
  ++(moments_.add_line(line, counters_) ? counters_.lines : counters_.lines_refused);
}

bool ImplicitMesher::remove_last_sweep() {
  sweeps_.request();
  const std::int64_t removed = moments_.remove_last_sweep();
  if (removed < 0) return false;
  counters_.points_removed += static_cast<std::uint64_t>(removed);
  return true;
}

void ImplicitMesher::clear() {
  sweeps_ = SweepTracker(options_.sweep_pause);
  moments_.clear();
  patches_.clear();
  field_.clear();
  counters_ = {};
}

void ImplicitMesher::update() {
  if (moments_.changed().empty()) return;
  patches_.update(moments_, field_);
  moments_.forget_changes();
  field_.update();
}

void ImplicitMesher::write_mesh(TriangleMesh& mesh) {
  update();
  extractor_.extract(field_, mesh);
}

std::vector<Eigen::Vector3f> ImplicitMesher::grid_vertices() {
  update();
  std::vector<Eigen::Vector3f> result;
  for (const std::int32_t block : field_.table().ordered())
    for (int local = 0; local < kBlockCells; ++local) {
      const std::int32_t number = field_.vertex_near(block, local & 7, local >> 3 & 7, local >> 6);
      if (number == BlockTable::kNone) continue;
      const FieldVertex& vertex = field_.vertex(number);
      if (!vertex.known || vertex.support < 0 || std::abs(vertex.distance) > 0.5f) continue;
      result.push_back(
          (Eigen::Vector3d(vertex.at.x, vertex.at.y, vertex.at.z) * options_.interval).cast<float>());
    }
  return result;
}

MesherState ImplicitMesher::state() {
  update();
  MesherState result;
  result.occupied_cells = moments_.occupied();
  for (std::size_t i = 0; i < moments_.cell_count(); ++i) {
    const auto number = static_cast<std::int32_t>(i);
    if (moments_.cell(number).occupied() && !patches_.carries_surface(moments_, number)) ++result.set_aside;
  }
  result.sweeps = moments_.sweeps();
  result.memory_bytes = moments_.memory_bytes() + patches_.memory_bytes() + field_.memory_bytes();
  return result;
}

}  // namespace linescope
