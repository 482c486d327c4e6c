#include "viewer/surface/implicit_mesher.hpp"

#include <algorithm>
#include <cmath>

namespace linescope {

ImplicitMesher::ImplicitMesher(const MesherOptions& options)
    : options_(options),
      sweeps_(options.sweep_pause),
      quantizer_(options),
      moments_(options.interval, options.max_memory),
      patches_(options),
      extractor_(options.interval) {}

void ImplicitMesher::add_line(const SurfaceLine& line) {
  const PlacedLine placed = quantizer_.place(line, counters_);
  if (placed.usable() == 0) {
    ++counters_.lines_refused;
    return;
  }
  if (sweeps_.begins_with(line.time)) moments_.begin_sweep();
  const std::uint64_t used = moments_.add_line(placed, line.seen_from);
  counters_.points += used;
  counters_.no_room += placed.usable() - used;
  ++(used != 0 ? counters_.lines : counters_.lines_refused);
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
  holes_ = {};
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
  if (options_.fill_holes_up_to > 0) holes_ = fill_holes(mesh, options_.fill_holes_up_to);
}

std::vector<Eigen::Vector3f> ImplicitMesher::grid_vertices() {
  update();
  std::vector<Eigen::Vector3f> result;
  field_.for_each_ordered([&](std::int32_t number) {
    const FieldVertex& vertex = field_.vertex(number);
    if (!vertex.known || vertex.support < 0 || std::abs(vertex.distance) > 0.5f) return;
    result.push_back(
        (Eigen::Vector3d(vertex.at.x, vertex.at.y, vertex.at.z) * options_.interval).cast<float>());
  });
  return result;
}

std::optional<HoleCounts> ImplicitMesher::holes() const {
  return options_.fill_holes_up_to > 0 ? std::optional(holes_) : std::nullopt;
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
