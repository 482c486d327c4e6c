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

// One patch's say about its four columns of vertices.
struct Stamp {
  std::int64_t weight;
  std::array<std::int64_t, 3> normal;
  std::array<std::int64_t, 3> centre;  // not yet weighted, from the cube's lowest corner
  std::int64_t deviation;
  std::int64_t points;
};

// Patches over the axis the normal points along count most: 64 times as much as those half as steep that just
// pass.
Stamp stamp_of(const SurfacePatch& patch, int sign) {
  const double along = patch.normal[static_cast<std::size_t>(patch.axis)], squared = along * along;
  const double counted = patch.weight / kTypicalWeight * squared * squared * squared;
  const std::int64_t weight = sign * std::clamp<std::int64_t>(fixed(counted, kWeightUnit), 1, kMaxWeight);
  Stamp stamp{weight,
              {},
              {},
              weight * fixed(std::min(patch.deviation, 100.0), kDistanceUnit),
              sign * fixed(patch.points, 1)};
  for (std::size_t i = 0; i < 3; ++i) {
    stamp.normal[i] = weight * fixed(patch.normal[i], kNormalUnit);
    stamp.centre[i] = fixed(patch.centre[i], kDistanceUnit);
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

void DistanceField::apply(const MomentCell& cell, const SurfacePatch& patch, int sign) {
  const Stamp stamp = stamp_of(patch, sign);
  const auto h = static_cast<std::size_t>(patch.axis);
  const int u = (patch.axis + 1) % 3, v = (patch.axis + 2) % 3;
  const double along = patch.normal[h];
  const double slope = (std::abs(patch.normal[static_cast<std::size_t>(u)]) +
                        std::abs(patch.normal[static_cast<std::size_t>(v)])) /
                       std::abs(along);
  const double reach = std::min(1.0 + slope, 3.0);
  const std::int64_t rise = fixed(along, kDistanceUnit);  // of the distance, per interval along the axis
  for (int corner = 0; corner < 4; ++corner) {
    const double height = patch.height[static_cast<std::size_t>(corner)];
    if (!(std::abs(height) < 2 * kPatchReach)) continue;
    const GridIndex foot = plus(plus(cell.at, u, corner & 1), v, corner >> 1);
    const int low = static_cast<int>(std::floor(height - reach)),
              high = static_cast<int>(std::ceil(height + reach));
    const std::int64_t at_foot = fixed(-height * along, kDistanceUnit);
    for (int k = low; k <= high; ++k) {
      const std::int32_t number = vertex_at(plus(foot, patch.axis, k));
      FieldVertex& vertex = vertices_[number];
      VertexSums& sums = vertex.sums;
      sums.weight += stamp.weight;
      sums.distance += stamp.weight * (at_foot + k * rise);
      sums.deviation += stamp.deviation;
      sums.points += stamp.points;
      const std::array<int, 3> from_cell{vertex.at.x - cell.at.x, vertex.at.y - cell.at.y,
                                         vertex.at.z - cell.at.z};
      for (std::size_t i = 0; i < 3; ++i) {
        sums.normal[i] += stamp.normal[i];
        sums.centre[i] += stamp.weight * (stamp.centre[i] - from_cell[i] * kDistanceStep);
      }
      if (vertex.changed) continue;
      vertex.changed = true;
      changed_.push_back(number);
    }
  }
}

std::int32_t DistanceField::vertex_at(GridIndex at) {
  SparseIndex::Block& block = index_.block(block_of(at));
  std::int32_t& number = block.number[static_cast<std::size_t>(local_of(at))];
  if (number != SparseIndex::kNone) return number;
  number = vertices_.add();
  vertices_[number].at = at;
  vertices_[number].block = &block;
  return number;
}

std::array<std::int32_t, 8> DistanceField::corners_of(const FieldVertex& low) const {
  return SparseIndex::corners(*low.block, low.at, 1);
}

void DistanceField::update() {
  ++round_;
  for (const std::int32_t number : changed_) evaluate(vertices_[number]);
  for (const std::int32_t number : changed_) {
    const FieldVertex& at = vertices_[number];
    for (const std::int32_t low : SparseIndex::corners(*at.block, at.at, -1)) {
      if (low == SparseIndex::kNone || vertices_[low].round == round_) continue;
      vertices_[low].round = round_;
      find_case(vertices_[low]);
    }
  }
  for (const std::int32_t number : changed_) vertices_[number].changed = false;
  changed_.clear();
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
