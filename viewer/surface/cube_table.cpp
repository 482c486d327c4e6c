#include "viewer/surface/cube_table.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace linescope {
namespace {

using Corners = std::array<std::uint8_t, 8>;  // where a rotation takes each corner

// The corners of each face, counter-clockwise seen from outside the cube.
constexpr std::array<std::array<std::uint8_t, 4>, 6> kFaces{{
    {0, 4, 6, 2},  // x = 0
    {1, 3, 7, 5},  // x = 1
    {0, 1, 5, 4},  // y = 0
    {2, 6, 7, 3},  // y = 1
    {0, 2, 3, 1},  // z = 0
    {4, 5, 7, 6},  // z = 1
}};

constexpr bool marked(int corners, int corner) {
  return (corners >> corner & 1) != 0;
}

// On every face a line leads from the edge where the walk around the face enters the marked corners to the
// edge where it leaves them; the neighbouring face continues from there. next[e] is where the line from edge
// e leads, 12 if nowhere.
constexpr std::array<std::uint8_t, 12> lines_on_faces(int corners) {
  std::array<std::uint8_t, 12> next{};
  next.fill(12);
  for (const auto& face : kFaces)
    for (int i = 0; i < 4; ++i) {
      if (marked(corners, face[i]) || !marked(corners, face[(i + 1) % 4])) continue;
      int last = i + 1;
      while (marked(corners, face[(last + 1) % 4])) ++last;
      next[edge_between(face[i], face[(i + 1) % 4])] =
          static_cast<std::uint8_t>(edge_between(face[last % 4], face[(last + 1) % 4]));
    }
  return next;
}

Eigen::Vector3d midpoint(int edge) {
  const EdgeCorners ends = edge_corners(edge);
  const auto place = [](int corner) { return Eigen::Vector3d(corner & 1, corner >> 1 & 1, corner >> 2 & 1); };
  return 0.5 * (place(ends.low) + place(ends.high));
}

using Loop = std::vector<int>;  // the edges that a polygon runs through

struct Fan {
  bool symmetric = true;  // the spokes to both sides are equally long
  double area = 0;
};

Fan fan(const Loop& loop) {
  Fan result;
  const Eigen::Vector3d apex = midpoint(loop.front());
  for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
    const Eigen::Vector3d spoke = midpoint(loop[i]) - apex, next = midpoint(loop[i + 1]) - apex;
    const Eigen::Vector3d mirrored = midpoint(loop[loop.size() - i]) - apex;
    result.symmetric = result.symmetric && std::abs(spoke.norm() - mirrored.norm()) < 1e-9;
    result.area += 0.5 * spoke.cross(next).norm();
  }
  return result;
}

// The polygon begun at the apex of the fan it is cut into.
Loop begun_at_apex(Loop loop) {
  Loop best = loop;
  for (std::size_t turn = 1; turn < loop.size(); ++turn) {
    std::rotate(loop.begin(), loop.begin() + 1, loop.end());
    const Fan now = fan(loop), before = fan(best);
    const bool better = loop.size() == 7 ? now.symmetric && !before.symmetric : now.area > before.area + 1e-9;
    if (better) best = loop;
  }
  return best;
}

std::vector<Loop> polygons(int corners) {
  std::vector<Loop> result;
  auto next = lines_on_faces(corners);
  for (int start = 0; start < 12; ++start) {
    Loop loop;
    for (int e = start; next[e] != 12;) {
      loop.push_back(e);
      e = std::exchange(next[e], std::uint8_t{12});
    }
    if (!loop.empty()) result.push_back(begun_at_apex(loop));
  }
  return result;
}

CubeCase traced(int corners) {
  CubeCase result;
  std::size_t vertices = 0;
  for (const Loop& loop : polygons(corners)) {
    for (const int edge : loop) result.edges = static_cast<std::uint16_t>(result.edges | 1 << edge);
    for (std::size_t i = 1; i + 1 < loop.size(); ++i)
      for (const std::size_t corner : {std::size_t{0}, i, i + 1})
        result.vertices[vertices++] = static_cast<std::uint8_t>(loop[corner]);
  }
  result.triangles = static_cast<std::uint8_t>(vertices / 3);
  return result;
}

// Quarter turns about x and about z generate all 24 rotations.
constexpr Corners quarter_turn_x() {
  Corners turn{};
  for (int c = 0; c < 8; ++c)
    turn[c] = static_cast<std::uint8_t>((c & 1) | (c >> 2 & 1 ? 0 : 2) | (c >> 1 & 1 ? 4 : 0));
  return turn;
}
constexpr Corners quarter_turn_z() {
  Corners turn{};
  for (int c = 0; c < 8; ++c)
    turn[c] = static_cast<std::uint8_t>((c >> 1 & 1 ? 0 : 1) | (c & 1 ? 2 : 0) | (c & 4));
  return turn;
}
constexpr Corners then(const Corners& first, const Corners& second) {
  Corners both{};
  for (int c = 0; c < 8; ++c) both[c] = second[first[c]];
  return both;
}

constexpr std::array<Corners, 24> rotations() {
  std::array<Corners, 24> all{};
  all[0] = {0, 1, 2, 3, 4, 5, 6, 7};
  int count = 1;
  for (int i = 0; i < count; ++i)
    for (const Corners& turn : {quarter_turn_x(), quarter_turn_z()}) {
      const Corners candidate = then(all[i], turn);
      bool known = false;
      for (int k = 0; k < count; ++k) known = known || all[k] == candidate;
      if (!known) all[count++] = candidate;
    }
  return all;
}
constexpr std::array<Corners, 24> kRotations = rotations();

constexpr int rotated(int corners, const Corners& rotation) {
  int result = 0;
  for (int c = 0; c < 8; ++c)
    if (marked(corners, c)) result |= 1 << rotation[c];
  return result;
}

constexpr CubeCase rotated(const CubeCase& from, const Corners& rotation) {
  CubeCase result;
  result.triangles = from.triangles;
  for (int i = 0; i < 3 * from.triangles; ++i) {
    const EdgeCorners ends = edge_corners(from.vertices[i]);
    const int edge = edge_between(rotation[ends.low], rotation[ends.high]);
    result.vertices[i] = static_cast<std::uint8_t>(edge);
    result.edges = static_cast<std::uint16_t>(result.edges | 1 << edge);
  }
  return result;
}

struct Table {
  std::array<CubeCase, 256> cases{};
  std::array<std::uint8_t, 256> pattern{};
};

// The first member of each class under rotation is traced, the others are its images.
void expand_classes(Table& table) {
  std::array<bool, 256> known{};
  for (int corners = 0; corners < 256; ++corners) {
    if (known[corners]) continue;
    const CubeCase original = traced(corners);
    for (const Corners& rotation : kRotations) {
      const int image = rotated(corners, rotation);
      if (known[image]) continue;
      known[image] = true;
      table.cases[image] = rotated(original, rotation);
    }
  }
}

void number_patterns(Table& table) {
  table.pattern.fill(255);
  std::uint8_t next = 0;
  for (int corners = 0; corners < 256; ++corners) {
    if (table.pattern[corners] != 255) continue;
    for (const Corners& rotation : kRotations) {
      const int image = rotated(corners, rotation);
      table.pattern[image] = table.pattern[255 - image] = next;
    }
    ++next;
  }
}

const Table& table() {
  static const Table built = [] {
    Table result;
    expand_classes(result);
    number_patterns(result);
    return result;
  }();
  return built;
}

}  // namespace

const CubeCase& cube_case(std::uint8_t corners) {
  return table().cases[corners];
}

int cube_pattern(std::uint8_t corners) {
  return table().pattern[corners];
}

}  // namespace linescope
