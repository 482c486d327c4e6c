// Holes are closed on request only, in triangles that say so, and never across the outer border.
#include "viewer/surface/hole_filler.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "tests/unit/surface/mesh_topology.hpp"
#include "tests/unit/surface/surface_phantom.hpp"
#include "viewer/surface/mesher.hpp"
#include "viewer/surface/rim_lid.hpp"

namespace linescope {
namespace {

constexpr double kHoleRadius = 2.5;  // mm

testing::CondyleScan scan_with_hole() {
  auto scan = testing::scan_condyle();
  for (auto& line : scan.lines)
    std::erase_if(line.points,
                  [](const SurfacePoint& p) { return p.position.head<2>().norm() < kHoleRadius; });
  return scan;
}

TriangleMesh mesh_of(const testing::CondyleScan& scan, double fill_up_to) {
  MesherOptions options;
  options.fill_holes_up_to = fill_up_to;
  const auto mesher = std::move(*make_mesher(options));
  testing::add_all(*mesher, scan.lines);
  return mesher->mesh();
}

TEST(HoleFiller, ClosesTheHoleAndSaysWhereItDid) {
  const auto scan = scan_with_hole();
  const TriangleMesh open = mesh_of(scan, 0), closed = mesh_of(scan, 25);
  const auto topology = testing::topology_of(closed);
  EXPECT_EQ(topology.euler(), 1);  // a disc, where the open mesh is a ring
  EXPECT_EQ(topology.pieces, 1u);
  EXPECT_EQ(topology.repeated_edges, 0u);
  ASSERT_GT(closed.triangle_count(), open.triangle_count());
  ASSERT_EQ(closed.origin.size(), closed.triangle_count());
  for (std::size_t i = 0; i < closed.triangle_count(); ++i) {
    const bool added = i >= open.triangle_count();
    EXPECT_EQ(closed.origin[i], added ? TriangleOrigin::filled : TriangleOrigin::measured) << i;
    if (!added) {
      EXPECT_EQ(closed.triangles[i], open.triangles[i]) << i;
    }
  }
}

TEST(HoleFiller, WhatIsAddedHasNoObservationsAndGoesOnWithTheCurvature) {
  const auto scan = scan_with_hole();
  const TriangleMesh open = mesh_of(scan, 0), closed = mesh_of(scan, 25);
  ASSERT_GT(closed.vertex_count(), open.vertex_count());
  for (std::size_t i = open.vertex_count(); i < closed.vertex_count(); ++i) {
    EXPECT_EQ(closed.observations[i], 0u);
    EXPECT_TRUE(std::isnan(closed.uncertainty[i]));
    EXPECT_LT(closed.positions[i].head<2>().norm(), kHoleRadius);
    // A lid without curvature would lie r^2 / 2R = 0.13 mm too low in the middle.
    EXPECT_LT(std::abs(scan.distance(closed.positions[i])), 0.06);
    const Eigen::Vector3d truth = scan.truth.normal(closed.positions[i].cast<double>());
    EXPECT_GT(closed.normals[i].cast<double>().dot(truth), std::cos(0.1));
  }
  for (const auto& [a, b, c] : closed.triangles) {
    const Eigen::Vector3f across =
        (closed.positions[b] - closed.positions[a]).cross(closed.positions[c] - closed.positions[a]);
    EXPECT_GE(across.dot(closed.normals[a]), 0);
  }
}

TEST(HoleFiller, LeavesLongRimsAndTheOuterBorderOpen) {
  const auto scan = scan_with_hole();
  const TriangleMesh open = mesh_of(scan, 0);
  EXPECT_EQ(mesh_of(scan, 8).triangles, open.triangles);  // the rim is some 14 mm long
  TriangleMesh mesh = open;
  HoleCounts counts = fill_holes(mesh, 8);
  EXPECT_EQ(counts.filled, 0u);
  EXPECT_EQ(counts.left, 1u);
  counts = fill_holes(mesh, 1000);  // longer than the outer border
  EXPECT_EQ(counts.filled, 1u);
  EXPECT_EQ(counts.left, 0u);
  EXPECT_GT(testing::topology_of(mesh).open_edges, 50u);
  counts = fill_holes(mesh, 1000);
  EXPECT_EQ(counts.filled, 0u);
}

TEST(HoleFiller, TheMesherSaysWhatBecameOfTheHoles) {
  const auto scan = scan_with_hole();
  MesherOptions options;
  options.fill_holes_up_to = 8;
  const auto strict = std::move(*make_mesher(options));
  testing::add_all(*strict, scan.lines);
  strict->mesh();
  EXPECT_EQ(strict->holes()->too_long, 1u);
  EXPECT_EQ(strict->holes()->filled, 0u);
  options.fill_holes_up_to = 25;
  const auto generous = std::move(*make_mesher(options));
  testing::add_all(*generous, scan.lines);
  generous->mesh();
  EXPECT_EQ(generous->holes()->filled, 1u);
  EXPECT_EQ(generous->holes()->left, 0u);
  generous->clear();
  EXPECT_EQ(generous->holes()->filled, 0u);
}

/// A flat square of `cells` x `cells` squares of 1 mm, some of them missing.
TriangleMesh flat_mesh(int cells, const std::vector<std::array<int, 2>>& missing) {
  TriangleMesh mesh;
  for (int y = 0; y <= cells; ++y)
    for (int x = 0; x <= cells; ++x) {
      mesh.positions.emplace_back(static_cast<float>(x), static_cast<float>(y), 0.0f);
      mesh.normals.emplace_back(0, 0, 1);
      mesh.uncertainty.push_back(0.1f);
      mesh.observations.push_back(1);
    }
  for (int y = 0; y < cells; ++y)
    for (int x = 0; x < cells; ++x) {
      if (std::find(missing.begin(), missing.end(), std::array{x, y}) != missing.end()) continue;
      const auto at = [&](int dx, int dy) {
        return static_cast<std::uint32_t>((y + dy) * (cells + 1) + x + dx);
      };
      mesh.triangles.push_back({at(0, 0), at(1, 0), at(1, 1)});
      mesh.triangles.push_back({at(0, 0), at(1, 1), at(0, 1)});
    }
  mesh.origin.assign(mesh.triangle_count(), TriangleOrigin::measured);
  return mesh;
}

TEST(HoleFiller, HolesThatTouchInACornerAreTwoHoles) {
  TriangleMesh mesh = flat_mesh(6, {{2, 2}, {3, 3}});
  const HoleCounts counts = fill_holes(mesh, 10);
  EXPECT_EQ(counts.filled, 2u);
  EXPECT_NEAR(mesh.area(), 36, 1e-4);
  EXPECT_EQ(testing::topology_of(mesh).repeated_edges, 0u);
  EXPECT_EQ(testing::topology_of(mesh).open_edges, 24u);
}

std::vector<std::array<int, 2>> bent_hole() {
  return {{1, 1}, {2, 1}, {3, 1}, {4, 1}, {5, 1}, {5, 2}, {5, 3}, {5, 4}, {5, 5}};
}

TEST(HoleFiller, ARimThatHidesPartOfItselfIsClosedWithoutAFold) {
  const TriangleMesh bent = flat_mesh(8, bent_hole());
  TriangleMesh mesh = bent;
  const HoleCounts counts = fill_holes(mesh, 100);
  EXPECT_EQ(counts.filled, 1u);
  EXPECT_EQ(counts.left, 0u);
  EXPECT_NEAR(mesh.area(), 64, 1e-4);  // more would be a fold
  const auto topology = testing::topology_of(mesh);
  EXPECT_EQ(topology.euler(), 1);
  EXPECT_EQ(topology.repeated_edges, 0u);
  EXPECT_EQ(topology.open_edges, 32u);
  EXPECT_EQ(mesh.filled_count(), mesh.triangle_count() - bent.triangle_count());
  for (const auto& [a, b, c] : mesh.triangles)
    EXPECT_GT((mesh.positions[b] - mesh.positions[a]).cross(mesh.positions[c] - mesh.positions[a]).z(), 0);
  for (std::size_t i = bent.vertex_count(); i < mesh.vertex_count(); ++i) {
    EXPECT_EQ(mesh.observations[i], 0u);
    EXPECT_TRUE(std::isnan(mesh.uncertainty[i]));
  }
}

// A bend three squares wide in a sphere: new vertices go on with its curvature. Edges straight across the
// hole would lie more than 0.1 mm low.
TEST(HoleFiller, ABentHoleInASphereFollowsTheSphere) {
  constexpr float kRadius = 25;
  std::vector<std::array<int, 2>> missing;
  for (int y = 1; y < 11; ++y)
    for (int x = 1; x < 11; ++x)
      if (y < 4 || x > 7) missing.push_back({x, y});
  TriangleMesh mesh = flat_mesh(12, missing);
  const std::size_t measured = mesh.vertex_count(), before = mesh.triangle_count();
  for (std::size_t i = 0; i < measured; ++i) {
    Eigen::Vector3f& p = mesh.positions[i];
    p = Eigen::Vector3f(p.x() - 6, p.y() - 6, kRadius).normalized() * kRadius;
    mesh.normals[i] = p.normalized();
  }
  EXPECT_EQ(fill_holes(mesh, 100).filled, 1u);
  ASSERT_GT(mesh.vertex_count(), measured + 10);
  for (std::size_t i = measured; i < mesh.vertex_count(); ++i) {
    EXPECT_NEAR(mesh.positions[i].norm(), kRadius, 0.03) << i;
    EXPECT_GT(mesh.normals[i].dot(mesh.positions[i].normalized()), std::cos(0.1f)) << i;
  }
  for (std::size_t i = before; i < mesh.triangle_count(); ++i) {
    const auto& [a, b, c] = mesh.triangles[i];
    EXPECT_NEAR((mesh.positions[a] + mesh.positions[b] + mesh.positions[c]).norm() / 3, kRadius, 0.05) << i;
  }
  EXPECT_EQ(testing::topology_of(mesh).euler(), 1);
  EXPECT_EQ(testing::topology_of(mesh).repeated_edges, 0u);
}

TEST(HoleFiller, RimsWithTooManyVerticesAreLeftAndCounted) {
  std::vector<std::array<int, 2>> spiral;  // a comb: some 2 x 40 x 3 rim vertices, seen from nowhere at once
  for (int x = 1; x < 41; ++x) spiral.push_back({x, 1});
  for (int x = 1; x < 41; x += 4)
    for (int y = 2; y < 12; ++y) spiral.push_back({x, y});
  const TriangleMesh comb = flat_mesh(42, spiral);
  TriangleMesh mesh = comb;
  HoleCounts counts = fill_holes(mesh, 100);
  EXPECT_EQ(counts.too_long, 1u);
  counts = fill_holes(mesh, 1000);
  EXPECT_EQ(counts.filled, 0u);
  EXPECT_EQ(counts.too_many, 1u);
  EXPECT_EQ(counts.left, 1u);
  EXPECT_EQ(mesh.triangles, comb.triangles);
}

TEST(RimLid, ARimThatCrossesItselfSeenFromAboveHasNoLid) {
  const auto nothing_taken = [](std::size_t, std::size_t) { return false; };
  const std::vector<Eigen::Vector3d> eight{{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 2, 0}};
  EXPECT_FALSE(triangulate_rim(eight, nothing_taken).has_value());
  std::vector<Eigen::Vector3d> clockwise{{0, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}};
  EXPECT_FALSE(triangulate_rim(clockwise, nothing_taken).has_value());
  std::reverse(clockwise.begin(), clockwise.end());
  EXPECT_TRUE(triangulate_rim(clockwise, nothing_taken).has_value());
  EXPECT_FALSE(triangulate_rim({}, nothing_taken).has_value());
}

// A square with one corner up: cut off (1-3) its area is 1.366, cut through (0-2) 1.414.
TEST(RimLid, HasTheLeastAreaAndJoinsNothingTwice) {
  const std::vector<Eigen::Vector3d> bent{{0, 0, 1}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const auto area_of = [&](const RimLid& lid) {
    double area = 0;
    for (const auto& [a, b, c] : lid.triangles)
      area += 0.5 * (bent[b] - bent[a]).cross(bent[c] - bent[a]).norm();
    return area;
  };
  const auto free = triangulate_rim(bent, [](std::size_t, std::size_t) { return false; });
  ASSERT_TRUE(free.has_value());
  EXPECT_NEAR(area_of(*free), 0.5 + std::sqrt(3) / 2, 1e-12);
  const auto bound = triangulate_rim(bent, [](std::size_t i, std::size_t j) { return i == 1 && j == 3; });
  ASSERT_TRUE(bound.has_value());
  EXPECT_NEAR(area_of(*bound), std::sqrt(2), 1e-12);
}

TEST(HoleFiller, AnEmptyMeshAndALoneTriangleStayAsTheyAre) {
  TriangleMesh mesh;
  EXPECT_EQ(fill_holes(mesh, 100).filled, 0u);
  mesh = flat_mesh(1, {});
  mesh.triangles.pop_back();
  mesh.origin.pop_back();
  EXPECT_EQ(fill_holes(mesh, 100).filled, 0u);
  EXPECT_EQ(mesh.triangle_count(), 1u);
}

}  // namespace
}  // namespace linescope
