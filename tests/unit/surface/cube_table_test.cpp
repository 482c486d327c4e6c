// The look-up table against VTK's, and its own promises: closed in every case, no crack between any two
// cubes.
#include "viewer/surface/cube_table.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <map>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "tests/unit/surface/vtk_cubes.hpp"

namespace linescope {
namespace {

using Point = std::tuple<float, float, float>;

Eigen::Vector3f corner_place(int corner) {
  return Eigen::Vector3f(static_cast<float>(corner & 1), static_cast<float>(corner >> 1 & 1),
                         static_cast<float>(corner >> 2));
}

Eigen::Vector3f midpoint(int edge) {
  const EdgeCorners ends = edge_corners(edge);
  return 0.5f * (corner_place(ends.low) + corner_place(ends.high));
}

TriangleMesh own_surface(int corners) {
  TriangleMesh mesh;
  for (int edge = 0; edge < 12; ++edge) mesh.positions.push_back(midpoint(edge));
  const CubeCase& found = cube_case(static_cast<std::uint8_t>(corners));
  for (int t = 0; t < found.triangles; ++t)
    mesh.triangles.push_back({found.vertices[3 * t], found.vertices[3 * t + 1], found.vertices[3 * t + 2]});
  return mesh;
}

std::set<Point> used_places(const TriangleMesh& mesh) {
  std::set<Point> places;
  for (const auto& triangle : mesh.triangles)
    for (const auto v : triangle)
      places.insert({mesh.positions[v].x(), mesh.positions[v].y(), mesh.positions[v].z()});
  return places;
}

Eigen::Vector3f area_vector(const TriangleMesh& mesh) {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (const auto& [a, b, c] : mesh.triangles)
    sum += (mesh.positions[b] - mesh.positions[a]).cross(mesh.positions[c] - mesh.positions[a]);
  return sum;
}

TEST(CubeTable, HasTheFifteenPatternsOfFigure49WithTheirKnownSizes) {
  std::map<int, int> size;
  for (int corners = 0; corners < 256; ++corners) ++size[cube_pattern(static_cast<std::uint8_t>(corners))];
  std::multiset<int> sizes;
  for (const auto& [pattern, count] : size) sizes.insert(count);
  // Number of cases per pattern, by hand from Burnside's count for rotations and complement.
  const std::multiset<int> expected{2, 16, 24, 24, 8, 48, 48, 16, 6, 8, 6, 12, 24, 2, 12};
  EXPECT_EQ(size.size(), 15u);
  EXPECT_EQ(sizes, expected);
}

TEST(CubeTable, NamesExactlyTheCrossedEdges) {
  for (int corners = 0; corners < 256; ++corners) {
    int crossed = 0;
    for (int edge = 0; edge < 12; ++edge) {
      const EdgeCorners ends = edge_corners(edge);
      if ((corners >> ends.low & 1) != (corners >> ends.high & 1)) crossed |= 1 << edge;
    }
    EXPECT_EQ(cube_case(static_cast<std::uint8_t>(corners)).edges, crossed) << corners;
  }
}

TEST(CubeTable, EdgesAndTheirCornersAgree) {
  for (int edge = 0; edge < 12; ++edge) {
    const EdgeCorners ends = edge_corners(edge);
    EXPECT_EQ(edge_between(ends.low, ends.high), edge);
    EXPECT_EQ(edge_between(ends.high, ends.low), edge);
    EXPECT_EQ(ends.high - ends.low, 1 << edge_axis(edge));
  }
}

TEST(CubeTable, EveryCaseIsThatOfVtk) {
  for (int corners = 0; corners < 256; ++corners) {
    testing::DenseGrid grid{{2, 2, 2}, std::vector<std::uint8_t>(8)};
    for (int c = 0; c < 8; ++c) grid.marked[static_cast<std::size_t>(c)] = corners >> c & 1;
    const TriangleMesh own = own_surface(corners);
    for (const auto filter : {testing::VtkFilter::marching_cubes, testing::VtkFilter::flying_edges}) {
      const TriangleMesh vtk = testing::vtk_surface(grid, filter);
      EXPECT_EQ(own.triangle_count(), vtk.triangle_count()) << corners;
      EXPECT_EQ(used_places(own), used_places(vtk)) << corners;
      EXPECT_NEAR(own.area(), vtk.area(), 1e-5) << corners;
    }
  }
}

TEST(CubeTable, TrianglesLookAwayFromTheMarkedCorners) {
  for (int corners = 1; corners < 255; ++corners) {
    Eigen::Vector3f to_unmarked = Eigen::Vector3f::Zero();
    for (int c = 0; c < 8; ++c)
      if ((corners >> c & 1) == 0) to_unmarked += corner_place(c) - Eigen::Vector3f::Constant(0.5f);
    EXPECT_GE(area_vector(own_surface(corners)).dot(to_unmarked), -1e-5f) << corners;
  }
  EXPECT_GT(area_vector(own_surface(0b00001111)).z(), 0);  // the lower four marked: the surface looks up
}

// Where a case's triangles have a border, it lies on the cube's faces, and there its direction is fixed by
// the face.
using Border = std::set<std::pair<int, int>>;
Border border_of(int corners) {
  Border directed, border;
  for (const auto& t : own_surface(corners).triangles)
    for (std::size_t i = 0; i < 3; ++i)
      directed.insert({static_cast<int>(t[i]), static_cast<int>(t[(i + 1) % 3])});
  for (const auto& [a, b] : directed)
    if (directed.count({b, a}) == 0) border.insert({a, b});
  return border;
}

TEST(CubeTable, NoCrackBetweenAnyTwoNeighbouringCubes) {
  // All 4096 ways to mark the twelve corners of two cubes side by side, along each axis: what the one leaves
  // open on the shared face the other closes, in the opposite direction.
  std::vector<Border> borders;
  for (int corners = 0; corners < 256; ++corners) borders.push_back(border_of(corners));
  for (int axis = 0; axis < 3; ++axis) {
    const auto edge_shift = [axis](int edge) {  // the same edge seen from the upper cube
      const EdgeCorners ends = edge_corners(edge);
      return edge_between(ends.low & ~(1 << axis), ends.high & ~(1 << axis));
    };
    const auto on_upper_face = [axis](int edge) {
      const EdgeCorners ends = edge_corners(edge);
      return edge_axis(edge) != axis && (ends.low >> axis & 1) == 1;
    };
    const auto on_lower_face = [axis](int edge) {
      return edge_axis(edge) != axis && (edge_corners(edge).low >> axis & 1) == 0;
    };
    std::array<int, 256> upper_face_bits{}, lower_face_bits{};
    for (int corners = 0; corners < 256; ++corners)
      for (int c = 0, u = 0, l = 0; c < 8; ++c)
        if (c >> axis & 1)
          upper_face_bits[static_cast<std::size_t>(corners)] |= (corners >> c & 1) << u++;
        else
          lower_face_bits[static_cast<std::size_t>(corners)] |= (corners >> c & 1) << l++;
    int pairs = 0;
    for (int low = 0; low < 256; ++low)
      for (int high = 0; high < 256; ++high) {
        if (upper_face_bits[static_cast<std::size_t>(low)] != lower_face_bits[static_cast<std::size_t>(high)])
          continue;
        ++pairs;
        std::map<std::pair<int, int>, int> open;
        for (const auto& [a, b] : borders[static_cast<std::size_t>(low)])
          if (on_upper_face(a) && on_upper_face(b)) ++open[{edge_shift(a), edge_shift(b)}];
        for (const auto& [a, b] : borders[static_cast<std::size_t>(high)])
          if (on_lower_face(a) && on_lower_face(b)) --open[{b, a}];
        for (const auto& [edge, count] : open)
          ASSERT_EQ(count, 0) << low << " beside " << high << " along " << axis;
      }
    EXPECT_EQ(pairs, 4096);
  }
}

}  // namespace
}  // namespace linescope
