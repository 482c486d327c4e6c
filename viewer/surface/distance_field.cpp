#include "viewer/surface/distance_field.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "viewer/surface/cube_table.hpp"

namespace linescope {
namespace {

// Fixed point: weights in sixteenths of a point, at most 2^14 points (more only after some twenty passes over
// a place), distances, centres and deviations in 2^-20 intervals, normals in 2^-16: 64 bits hold the sums of
// thousands of patches.
constexpr double kWeightUnit = 16;
constexpr std::int64_t kMaxWeight = 1 << 18;
constexpr std::int64_t kDistanceStep = 1 << 20;
constexpr double kDistanceUnit = kDistanceStep;
constexpr double kNormalUnit = 1 << 16;

constexpr double kSideAgreement =
    0.5;  // length of the mean normal below which the patches contradict each other
constexpr float kMaxStep =
    1.6f;  // intervals; distances of neighbouring vertices differ by less on one surface

// Rounds to the nearest; std::llround is a call into the library.
std::int64_t fixed(double value, double unit) {
  const double scaled = value * unit;
  return static_cast<std::int64_t>(scaled + (scaled < 0 ? -0.5 : 0.5));
}

// One patch's say about its four columns of vertices; of those sums that differ from vertex to vertex only
// what is common.
struct Stamp {
  VertexSums sums;    // centre: of the points from the cube's lowest corner
  std::int64_t rise;  // of the distance, per interval along the axis; not weighted
};

// Patches over the axis the normal points along count most: 64 times as much as those half as steep that just
// pass.
Stamp stamp_of(const SurfacePatch& patch, int sign) {
  const double along = patch.normal[static_cast<std::size_t>(patch.axis)], squared = along * along;
  const double counted = patch.weight / kTypicalWeight * squared * squared * squared;
  const std::int64_t weight = sign * std::clamp<std::int64_t>(fixed(counted, kWeightUnit), 1, kMaxWeight);
  Stamp stamp{{}, fixed(along, kDistanceUnit)};
  stamp.sums.weight = weight;
  stamp.sums.deviation = weight * fixed(std::min(patch.deviation, 100.0), kDistanceUnit);
  stamp.sums.points = sign * fixed(patch.points, 1);
  for (std::size_t i = 0; i < 3; ++i) {
    stamp.sums.normal[i] = weight * fixed(patch.normal[i], kNormalUnit);
    stamp.sums.centre[i] = weight * fixed(patch.centre[i], kDistanceUnit);
  }
  return stamp;
}

// Points that fill the four columns around a vertex evenly up to a straight border at distance b (at most 1)
// have their mean (1 - b) / 2 off the vertex, counted across the columns. Noise moves the mean along the
// normal: that is taken out.
float support_of(const Eigen::Vector3d& centre, const Eigen::Vector3d& normal) {
  Eigen::Vector3d across = centre - normal * centre.dot(normal);
  Eigen::Index along = 0;
  normal.cwiseAbs().maxCoeff(&along);
  across[along] = 0;
  return static_cast<float>(1 - 2 * across.norm());
}

GridIndex plus(GridIndex at, int axis, int step) {
  (axis == 0 ? at.x : axis == 1 ? at.y : at.z) += step;
  return at;
}

}  // namespace

void VertexSums::add(const VertexSums& other) {
  weight += other.weight;
  distance += other.distance;
  for (std::size_t i = 0; i < 3; ++i) {
    normal[i] += other.normal[i];
    centre[i] += other.centre[i];
  }
  deviation += other.deviation;
  points += other.points;
}

void DistanceField::apply(const MomentCell& cell, const SurfacePatch& patch, int sign) {
  const Stamp stamp = stamp_of(patch, sign);
  const auto h = static_cast<std::size_t>(patch.axis), u = (h + 1) % 3, v = (h + 2) % 3;
  const double along = patch.normal[h];
  const double slope = (std::abs(patch.normal[u]) + std::abs(patch.normal[v])) / std::abs(along);
  const double reach = std::min(1.0 + slope, 3.0);
  const std::int64_t weight = stamp.sums.weight, step = weight * kDistanceStep;
  VertexSums one_up;
  one_up.distance = weight * stamp.rise;
  one_up.centre[h] = -step;
  for (std::size_t corner = 0; corner < 4; ++corner) {
    const double height = patch.height[corner];
    if (!(std::abs(height) < 2 * kPatchReach)) continue;
    const int du = static_cast<int>(corner & 1), dv = static_cast<int>(corner >> 1);
    const int low = static_cast<int>(std::floor(height - reach)),
              high = static_cast<int>(std::ceil(height + reach));
    VertexSums sums = stamp.sums;
    sums.distance = weight * (fixed(-height * along, kDistanceUnit) + low * stamp.rise);
    sums.centre[u] -= du * step;
    sums.centre[v] -= dv * step;
    sums.centre[h] -= low * step;
    const GridIndex foot = plus(plus(cell.at, static_cast<int>(u), du), static_cast<int>(v), dv);
    add_column(plus(foot, patch.axis, low), patch.axis, high - low + 1, sums, one_up);
  }
}

// To so many vertices one on the other, from the lowest on; each gets `one_up` more than the one below.
void DistanceField::add_column(GridIndex lowest, int axis, int count, VertexSums sums,
                               const VertexSums& one_up) {
  const int step = 1 << kBlockBits * axis;  // of the place in a block
  GridIndex at = lowest;
  while (count > 0) {
    SparseIndex::Block& block = index_.block(block_of(at));
    int local = local_of(at);
    const int rows = std::min(count, kBlockSize - (local >> kBlockBits * axis & (kBlockSize - 1)));
    for (int k = 0; k < rows; ++k, local += step) {
      add(vertex_at(block, local), sums);
      sums.add(one_up);
    }
    count -= rows;
    at = plus(at, axis, rows);
  }
}

void DistanceField::add(std::int32_t number, const VertexSums& sums) {
  FieldVertex& vertex = vertices_[number];
  vertex.sums.add(sums);
  if (vertex.changed) return;
  vertex.changed = true;
  changed_.push_back(number);
}

std::int32_t DistanceField::vertex_at(SparseIndex::Block& block, int local) {
  std::int32_t& number = block.number[static_cast<std::size_t>(local)];
  if (number != SparseIndex::kNone) return number;
  number = vertices_.add();
  vertices_[number].at = grid_of(block.at, local);
  vertices_[number].block = &block;
  return number;
}

std::array<std::int32_t, 8> DistanceField::corners_of(const FieldVertex& low) const {
  return SparseIndex::corners(*low.block, low.at, 1);
}

void DistanceField::update() {
  ++round_;
  for (const std::int32_t number : changed_) evaluate(vertices_[number]);
  if (changed_.size() == vertices_.size()) {
    for (const std::int32_t number : changed_) find_case(vertices_[number]);
  } else {
    for (const std::int32_t number : changed_) find_cases_near(vertices_[number]);
  }
  for (const std::int32_t number : changed_) vertices_[number].changed = false;
  changed_.clear();
}

// Those of the eight cubes that have the vertex as a corner, each once in an update.
void DistanceField::find_cases_near(const FieldVertex& vertex) {
  for (const std::int32_t low : SparseIndex::corners(*vertex.block, vertex.at, -1)) {
    if (low == SparseIndex::kNone || vertices_[low].round == round_) continue;
    vertices_[low].round = round_;
    find_case(vertices_[low]);
  }
}

void DistanceField::evaluate(FieldVertex& vertex) {
  const VertexSums& s = vertex.sums;
  vertex.known = false;
  if (s.weight == 0) return;
  const double inverse = 1.0 / static_cast<double>(s.weight);
  const auto mean = [inverse](std::int64_t sum, double unit) {
    return static_cast<double>(sum) * inverse / unit;
  };
  const Eigen::Vector3d normal(mean(s.normal[0], kNormalUnit), mean(s.normal[1], kNormalUnit),
                               mean(s.normal[2], kNormalUnit));
  const Eigen::Vector3d centre(mean(s.centre[0], kDistanceUnit), mean(s.centre[1], kDistanceUnit),
                               mean(s.centre[2], kDistanceUnit));
  const double length = normal.norm();
  vertex.known = length >= kSideAgreement;
  if (!vertex.known) return;
  const Eigen::Vector3d direction = normal / length;
  vertex.normal = direction.cast<float>();
  vertex.distance = static_cast<float>(mean(s.distance, kDistanceUnit));
  vertex.deviation = static_cast<float>(mean(s.deviation, kDistanceUnit));
  vertex.support = support_of(centre, direction);
}

void DistanceField::find_case(FieldVertex& vertex) {
  vertex.corners = 0;
  if (!vertex.known) return;
  const std::array<std::int32_t, 8> at = corners_of(vertex);
  unsigned inside = 0;
  for (std::size_t i = 0; i < 8; ++i) {
    if (at[i] == SparseIndex::kNone || !vertices_[at[i]].known) return;
    if (vertices_[at[i]].distance < 0) inside |= 1u << i;
  }
  if (inside == 0 || inside == 0xFF) return;
  const unsigned crossed = cube_case(static_cast<std::uint8_t>(inside)).edges;
  for (unsigned bits = crossed; bits != 0; bits &= bits - 1) {
    const int edge = std::countr_zero(bits);
    const EdgeCorners ends = edge_corners(edge);
    const FieldVertex &low = vertices_[at[ends.low]], &high = vertices_[at[ends.high]];
    const float rise = high.distance - low.distance;
    const float expected = low.normal[edge_axis(edge)] + high.normal[edge_axis(edge)];
    if (std::abs(rise) > kMaxStep || rise * expected < -0.5f) return;  // two surfaces, or the back of one
  }
  vertex.corners = static_cast<std::uint8_t>(inside);
}

void DistanceField::clear() {
  index_.clear();
  vertices_.clear();
  changed_.clear();
}

std::size_t DistanceField::memory_bytes() const {
  return index_.memory_bytes() + vertices_.size() * sizeof(FieldVertex);
}

}  // namespace linescope
