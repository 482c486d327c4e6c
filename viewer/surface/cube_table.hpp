// The look-up table of marching cubes (thesis 4.3.2, Figs 4.9 and 4.10): 256 cases, from 15 patterns.
//
// Corner c of a cube lies at (c & 1, c >> 1 & 1, c >> 2 & 1). Edge e runs along axis e / 4; the two bits of e
// % 4 are the other two coordinates in the order of the axes (edge 5: axis y, x = 1, z = 0). Bit c of a case
// is set where corner c is marked (inside).
//
// The table is not a list of numbers: the triangles of one member of each class are traced along the faces of
// the cube and carried to the other members by the cube's 24 rotations. On a face with two marked corners
// across a diagonal the marked corners are kept apart. The choice looks at nothing but the face, so two cubes
// always agree on the face between them and the surface has no cracks. A bent polygon is cut as the fan with
// the largest area; the one with seven corners (24 cases) as the fan that mirrors itself. VTK's table makes
// the same choices (the tests compare all 256 cases).
#pragma once

#include <array>
#include <cstdint>

namespace linescope {

struct CubeCase {
  std::uint8_t triangles = 0;  ///< 0 .. 5
  std::uint16_t edges = 0;     ///< bit e: edge e is crossed
  std::array<std::uint8_t, 15>
      vertices{};  ///< edge numbers, three per triangle, counter-clockwise seen from the unmarked side
};

/// The case for the eight corner bits.
const CubeCase& cube_case(std::uint8_t corners);

/// Which of the 15 patterns of Fig 4.9 a case belongs to: cases that a rotation, or a rotation and swapping
/// marked with unmarked, takes into each other. Numbered by their smallest member: 0 is the empty cube.
int cube_pattern(std::uint8_t corners);

/// The lower and the upper corner of an edge.
struct EdgeCorners {
  std::uint8_t low = 0;
  std::uint8_t high = 0;
};
constexpr EdgeCorners edge_corners(int edge) {
  const int axis = edge / 4;
  const int a = edge % 4 & 1, b = edge % 4 >> 1;
  const int first = axis == 0 ? 1 : 0, second = axis == 2 ? 1 : 2;
  const int low = a << first | b << second;
  return {static_cast<std::uint8_t>(low), static_cast<std::uint8_t>(low | 1 << axis)};
}
constexpr int edge_axis(int edge) {
  return edge / 4;
}

/// The edge between two corners that differ in one coordinate.
constexpr int edge_between(int corner_a, int corner_b) {
  const int low = corner_a < corner_b ? corner_a : corner_b;
  const int bit = corner_a ^ corner_b;
  const int axis = bit == 1 ? 0 : bit == 2 ? 1 : 2;
  const int first = axis == 0 ? 1 : 0, second = axis == 2 ? 1 : 2;
  return axis * 4 + ((low >> first & 1) | (low >> second & 1) << 1);
}

}  // namespace linescope
