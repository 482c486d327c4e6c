// PMC against VTK's marching cubes over the same grid, and what the interface promises.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "tests/unit/surface/mesh_topology.hpp"
#include "tests/unit/surface/surface_phantom.hpp"
#include "tests/unit/surface/vtk_cubes.hpp"
#include "viewer/surface/block_table.hpp"
#include "viewer/surface/mesher.hpp"

namespace linescope {
namespace {

using testing::DenseGrid;

std::unique_ptr<Mesher> pmc(double interval = 1.27) {
  MesherOptions options;
  options.method = MeshMethod::proposed_cubes;
  options.interval = interval;
  auto mesher = make_mesher(options);
  EXPECT_TRUE(mesher.has_value());
  return std::move(*mesher);
}

std::vector<std::array<float, 3>> sorted_places(const TriangleMesh& mesh) {
  std::vector<std::array<float, 3>> places;
  for (const auto& p : mesh.positions) places.push_back({p.x(), p.y(), p.z()});
  std::sort(places.begin(), places.end());
  return places;
}

DenseGrid random_grid(testing::Noise& noise) {
  const auto side = [&] { return 3 + static_cast<int>(noise.uniform() * 5); };
  DenseGrid grid{{side() + 2, side() + 2, side() + 2}, {}};
  grid.marked.resize(static_cast<std::size_t>(grid.size[0] * grid.size[1] * grid.size[2]));
  const double density = noise.uniform();
  for (int z = 1; z + 1 < grid.size[2]; ++z)
    for (int y = 1; y + 1 < grid.size[1]; ++y)
      for (int x = 1; x + 1 < grid.size[0]; ++x) grid.at(x, y, z) = noise.uniform() < density;
  return grid;
}

/// One point per marked vertex, somewhere in the cube around it; `origin` shifts the grid over block borders.
std::vector<SurfacePoint> points_for(DenseGrid& grid, GridIndex origin, testing::Noise& noise) {
  std::vector<SurfacePoint> points;
  const auto place = [&](int index, int shift) {
    return static_cast<float>(index + shift + 0.98 * (noise.uniform() - 0.5));
  };
  for (int z = 0; z < grid.size[2]; ++z)
    for (int y = 0; y < grid.size[1]; ++y)
      for (int x = 0; x < grid.size[0]; ++x)
        if (grid.at(x, y, z))
          points.push_back({{place(x, origin.x), place(y, origin.y), place(z, origin.z)}, 0, 0});
  return points;
}

TEST(Pmc, EqualsVtkOnTenThousandRandomGrids) {
  testing::Noise noise(20240601);
  auto mesher = pmc(1.0);
  for (int round = 0; round < 10'000; ++round) {
    DenseGrid grid = random_grid(noise);
    const auto shift = [&] { return static_cast<int>(noise.uniform() * 24) - 12; };
    const GridIndex origin{shift(), shift(), shift()};
    const auto points = points_for(grid, origin, noise);
    mesher->clear();
    mesher->add_line({.points = points});
    TriangleMesh own = mesher->mesh();
    const auto filter =
        round % 2 == 0 ? testing::VtkFilter::marching_cubes : testing::VtkFilter::flying_edges;
    TriangleMesh vtk = testing::vtk_surface(grid, filter);
    for (auto& p : vtk.positions)
      p += Eigen::Vector3f(static_cast<float>(origin.x), static_cast<float>(origin.y),
                           static_cast<float>(origin.z));
    ASSERT_EQ(sorted_places(own), sorted_places(vtk)) << "grid " << round;
    ASSERT_EQ(own.triangle_count(), vtk.triangle_count()) << "grid " << round;
    ASSERT_NEAR(own.area(), vtk.area(), 1e-4 * (1 + vtk.area())) << "grid " << round;
    const auto a = testing::topology_of(own), b = testing::topology_of(vtk);
    ASSERT_TRUE(a.closed()) << "grid " << round;
    ASSERT_EQ(a.degenerate, 0u) << "grid " << round;
    ASSERT_EQ(a.pieces, b.pieces) << "grid " << round;
    ASSERT_EQ(a.euler(), b.euler()) << "grid " << round;
  }
}

/// The marked vertices as a dense grid with an empty layer around.
DenseGrid dense_grid(const std::vector<Eigen::Vector3f>& vertices, double interval) {
  Eigen::Array3i low = Eigen::Array3i::Constant(1 << 20), high = -low;
  std::vector<Eigen::Array3i> marked;
  for (const auto& v : vertices) {
    marked.push_back((v.array().cast<double>() / interval).round().cast<int>());
    low = low.min(marked.back());
    high = high.max(marked.back());
  }
  DenseGrid grid{{high.x() - low.x() + 3, high.y() - low.y() + 3, high.z() - low.z() + 3}, {}};
  grid.marked.resize(static_cast<std::size_t>(grid.size[0] * grid.size[1] * grid.size[2]));
  for (const auto& m : marked) grid.at(m.x() - low.x() + 1, m.y() - low.y() + 1, m.z() - low.z() + 1) = 1;
  return grid;
}

void expect_equal_to_vtk(Mesher& mesher) {
  const double interval = mesher.options().interval;
  DenseGrid grid = dense_grid(mesher.grid_vertices(), interval);
  const TriangleMesh own = mesher.mesh();
  for (const auto filter : {testing::VtkFilter::marching_cubes, testing::VtkFilter::flying_edges}) {
    const TriangleMesh vtk = testing::vtk_surface(grid, filter);
    EXPECT_EQ(own.vertex_count(), vtk.vertex_count());
    EXPECT_EQ(own.triangle_count(), vtk.triangle_count());
    EXPECT_NEAR(own.area(), vtk.area() * interval * interval, 1e-4 * own.area());
    const auto a = testing::topology_of(own), b = testing::topology_of(vtk);
    EXPECT_EQ(a.pieces, b.pieces);
    EXPECT_EQ(a.euler(), b.euler());
    EXPECT_TRUE(a.closed());
  }
}

TEST(Pmc, EqualsVtkOnTheCondyle) {
  const auto scan = testing::scan_condyle();
  for (const double interval : kThesisIntervals) {
    SCOPED_TRACE(interval);
    auto mesher = pmc(interval);
    testing::add_all(*mesher, scan.lines);
    expect_equal_to_vtk(*mesher);
  }
}

/// A patch of 25 x 10 mm as a height over x and y, 40,000 points with noise along z.
std::vector<SurfacePoint> points_on(double (*height)(double, double), double noise_mm) {
  testing::Noise noise(31);
  std::vector<SurfacePoint> points(40'000);
  for (auto& p : points) {
    const double x = 25 * (noise.uniform() - 0.5), y = 10 * (noise.uniform() - 0.5);
    p.position = Eigen::Vector3d(x, y, height(x, y) + noise_mm * noise.gauss()).cast<float>();
  }
  return points;
}

TEST(Pmc, EqualsVtkOnPlaneCylinderAndMiniKnee) {
  const struct {
    const char* name;
    double (*height)(double, double);
  } phantoms[] = {{"plane", [](double x, double y) { return 0.2 * x - 0.1 * y; }},
                  {"cylinder, 49.1 mm", [](double x, double) { return std::sqrt(24.55 * 24.55 - x * x); }},
                  {"two condyles of 4 mm with a notch", [](double x, double y) {
                     const double left = 16 - (x - 3) * (x - 3) - y * y,
                                  right = 16 - (x + 3) * (x + 3) - y * y;
                     return std::sqrt(std::max({left, right, 0.0}));
                   }}};
  for (const auto& phantom : phantoms)
    for (const double interval : kThesisIntervals)
      for (const double noise : {0.0, 0.26, 1.5}) {
        SCOPED_TRACE(std::string(phantom.name) + ", t = " + std::to_string(interval));
        auto mesher = pmc(interval);
        mesher->add_line({.points = points_on(phantom.height, noise), .seen_from = {0, 0, 60}});
        expect_equal_to_vtk(*mesher);
      }
}

TEST(Pmc, MarksTheGridVertexNearestToThePoint) {
  // 4.3.2 (1): beyond the midpoint of an interval (0.635 mm) the upper grid plane wins, on every axis by
  // itself.
  auto mesher = pmc();
  const std::vector<SurfacePoint> points{{{0.6f, 0.7f, -0.7f}, 0, 0}};
  mesher->add_line({.points = points});
  const auto vertices = mesher->grid_vertices();
  ASSERT_EQ(vertices.size(), 1u);
  EXPECT_TRUE(vertices[0].isApprox(Eigen::Vector3f(0, 1.27f, -1.27f), 1e-6f));
}

TEST(Pmc, TheMidpointIsKeptToAThousandthOfAMillimetre) {
  for (const float side : {-1.0f, 1.0f})
    for (int plane = -5; plane < 5; ++plane) {
      auto mesher = pmc();
      const float midpoint = 1.27f * (static_cast<float>(plane) + 0.5f);
      const std::vector<SurfacePoint> points{{{midpoint + side * 0.001f, 0, 0}, 0, 0}};
      mesher->add_line({.points = points, .seen_from = {3, 4, 5}});
      const float expected = 1.27f * static_cast<float>(side > 0 ? plane + 1 : plane);
      EXPECT_NEAR(mesher->grid_vertices().at(0).x(), expected, 1e-4f) << plane << " " << side;
    }
}

TEST(Pmc, ALonePointIsAnOctahedronWithNormalsOutwards) {
  auto mesher = pmc(2.0);
  const std::vector<SurfacePoint> points{{{0.1f, 0, 0}, 0, 0}};
  mesher->add_line({.points = points});
  const TriangleMesh mesh = mesher->mesh();
  ASSERT_EQ(mesh.vertex_count(), 6u);
  ASSERT_EQ(mesh.triangle_count(), 8u);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_FLOAT_EQ(mesh.positions[i].norm(), 1.0f);  // midpoint of an edge of 2 mm
    EXPECT_TRUE(mesh.normals[i].isApprox(mesh.positions[i], 1e-6f));
    EXPECT_EQ(mesh.observations[i], 1u);
  }
}

TEST(Pmc, IsWhatTheNotesCalculateForTheDonorSite) {
  // thesis-notes: 94,000 points mark 437 vertices and give about 1,300 triangles, the outer side 1.26 mm off.
  const auto scan = testing::scan_condyle();
  auto mesher = pmc();
  testing::add_all(*mesher, scan.lines);
  EXPECT_NEAR(static_cast<double>(mesher->grid_vertices().size()), 437, 30);
  const TriangleMesh mesh = mesher->mesh();
  EXPECT_NEAR(static_cast<double>(mesh.triangle_count()), 1300, 200);
}

bool equal(const TriangleMesh& a, const TriangleMesh& b) {
  return a.positions == b.positions && a.normals == b.normals && a.triangles == b.triangles &&
         a.observations == b.observations;
}

TEST(Pmc, AskingAfterEveryLineGivesTheSameArraysAsAskingOnce) {
  const auto scan = testing::scan_condyle();
  for (const auto method : {MeshMethod::proposed_cubes, MeshMethod::classical_cubes}) {
    MesherOptions options;
    options.method = method;
    auto each = std::move(*make_mesher(options)), once = std::move(*make_mesher(options));
    for (const auto& line : scan.lines) {
      each->add_line(line.view());
      each->update();
    }
    testing::add_all(*once, scan.lines);
    EXPECT_TRUE(equal(each->mesh(), once->mesh()));
  }
}

TEST(Pmc, TheOrderOfTheLinesDoesNotMatter) {
  auto scan = testing::scan_condyle();
  auto forward = pmc(), backward = pmc();
  testing::add_all(*forward, scan.lines);
  std::reverse(scan.lines.begin(), scan.lines.end());
  testing::add_all(*backward, scan.lines);
  EXPECT_TRUE(equal(forward->mesh(), backward->mesh()));
}

TEST(Pmc, RemovingTheLastSweepIsAsIfItHadNeverBeen) {
  const auto scan = testing::scan_condyle();
  auto mesher = pmc();
  const std::span<const testing::ScannedLine> lines(scan.lines);
  for (const auto& line : lines.first(60)) mesher->add_line(line.view());
  const TriangleMesh before = mesher->mesh();
  mesher->begin_sweep();
  for (const auto& line : lines.subspan(40)) mesher->add_line(line.view());
  EXPECT_FALSE(equal(mesher->mesh(), before));
  EXPECT_EQ(mesher->state().sweeps, 2u);
  EXPECT_TRUE(mesher->remove_last_sweep());
  EXPECT_TRUE(equal(mesher->mesh(), before));
  EXPECT_EQ(mesher->counters().points_removed, 107u * 640u);
  EXPECT_TRUE(mesher->remove_last_sweep());
  EXPECT_TRUE(mesher->mesh().empty());
  EXPECT_FALSE(mesher->remove_last_sweep());
}

TEST(Pmc, APauseBeginsANewSweep) {
  auto mesher = pmc();
  const std::vector<SurfacePoint> here{{{0, 0, 0}, 0, 0}}, there{{{9, 0, 0}, 0, 0}};
  mesher->add_line({.points = here, .time = kSecond});
  mesher->add_line({.points = here, .time = kSecond + kSecond / 2});
  EXPECT_EQ(mesher->state().sweeps, 1u);
  mesher->add_line({.points = there, .time = 4 * kSecond});
  EXPECT_EQ(mesher->state().sweeps, 2u);
  mesher->remove_last_sweep();
  EXPECT_EQ(mesher->grid_vertices().size(), 1u);
}

TEST(Pmc, RefusesImpossiblePointsAndCountsThemByReason) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  auto mesher = pmc();
  const std::vector<SurfacePoint> points{
      {{0, 0, 0}, 0, 0.1f}, {{nan, 0, 0}, 0, 0.1f},  {{0, inf, 0}, 0, 0.1f}, {{0, 0, -inf}, 0, 0},
      {{0, 0, 0}, 0, nan},  {{1000, 0, 0}, 0, 0.1f}, {{0, 0, 0}, 0, -0.1f},  {{0, 0, 0}, 0, 50.0f}};
  mesher->add_line({.points = points});
  const MesherCounters counters = mesher->counters();
  EXPECT_EQ(counters.points, 1u);
  EXPECT_EQ(counters.not_finite, 4u);
  EXPECT_EQ(counters.too_far, 1u);
  EXPECT_EQ(counters.too_uncertain, 2u);
  EXPECT_EQ(counters.refused(), 7u);
  mesher->add_line({.points = points, .seen_from = {0, nan, 0}});
  EXPECT_EQ(mesher->counters().lines_refused, 1u);
  EXPECT_EQ(mesher->grid_vertices().size(), 1u);
}

TEST(Pmc, AnEmptyLineOrOneOfRefusedPointsIsCountedAndBeginsNoSweep) {
  auto mesher = pmc();
  mesher->add_line({});
  const std::vector<SurfacePoint> far{{{1000, 0, 0}, 0, 0}};
  mesher->add_line({.points = far});
  EXPECT_EQ(mesher->counters().lines_refused, 2u);
  EXPECT_EQ(mesher->counters().lines, 0u);
  EXPECT_EQ(mesher->state().sweeps, 0u);
  EXPECT_TRUE(mesher->mesh().empty());
}

TEST(Pmc, AllPointsEqualIsOneVertex) {
  auto mesher = pmc();
  const std::vector<SurfacePoint> points(5000, SurfacePoint{{3, 4, 5}, 0, 0});
  mesher->add_line({.points = points});
  EXPECT_EQ(mesher->grid_vertices().size(), 1u);
  EXPECT_EQ(mesher->mesh().observations.front(), 5000u);
}

TEST(Pmc, MoreCubesThanMemoryAllowsAreRefusedAndCounted) {
  MesherOptions options;
  options.method = MeshMethod::proposed_cubes;
  options.max_memory = 1'000'000;
  auto mesher = std::move(*make_mesher(options));
  testing::Noise noise(7);
  std::vector<SurfacePoint> points(20'000);
  for (auto& p : points)
    p.position =
        Eigen::Vector3d(noise.uniform() - 0.5, noise.uniform() - 0.5, noise.uniform() - 0.5).cast<float>() *
        290;
  mesher->add_line({.points = points});
  EXPECT_GT(mesher->counters().no_room, 10'000u);
  EXPECT_EQ(mesher->counters().no_room + mesher->counters().points, 20'000u);
  EXPECT_LE(mesher->state().memory_bytes, 2'000'000u);
  EXPECT_TRUE(testing::topology_of(mesher->mesh()).closed());
}

TEST(Pmc, AnIntervalTooSmallForTheNumberedGridRefusesPointsInsteadOfWrapping) {
  auto mesher = pmc(1e-9);
  const std::vector<SurfacePoint> points{{{10, 0, 0}, 0, 0}};
  mesher->add_line({.points = points});
  EXPECT_EQ(mesher->counters().no_room, 1u);
  EXPECT_TRUE(mesher->mesh().empty());
}

TEST(Pmc, MemoryFollowsTheSurfaceAndNotItsBox) {
  auto mesher = pmc();
  const std::vector<SurfacePoint> points{{{-70, -70, -70}, 0, 0}, {{70, 70, 70}, 0, 0}};
  mesher->add_line({.points = points});
  EXPECT_EQ(mesher->grid_vertices().size(), 2u);
  EXPECT_LT(mesher->state().memory_bytes, 100'000u);  // the box between them has 1.3 million vertices
}

TEST(Cmc, InterpolatesTheCrossingLinearlyInTheDensities) {
  MesherOptions options;
  options.method = MeshMethod::classical_cubes;
  options.interval = 1.0;
  options.isovalue = 2.0;
  auto mesher = std::move(*make_mesher(options));
  std::vector<SurfacePoint> points(8, SurfacePoint{{0, 0, 0}, 0, 0});
  points.push_back({{1, 0, 0}, 0, 0});
  mesher->add_line({.points = points});
  const TriangleMesh mesh = mesher->mesh();
  ASSERT_EQ(mesh.vertex_count(), 6u);
  // Eq 4.12: from 8 points to 1 the value 2 lies at 6/7, from 8 to 0 at 6/8.
  for (const auto& p : mesh.positions) EXPECT_NEAR(p.norm(), p.x() > 0.1f ? 6.0 / 7.0 : 6.0 / 8.0, 1e-6);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_GT(mesh.normals[i].dot(mesh.positions[i]), 0);
}

TEST(Cmc, HasThePmcCasesAtHalfAPoint) {
  const auto scan = testing::scan_condyle();
  MesherOptions options;
  options.method = MeshMethod::classical_cubes;
  auto classical = std::move(*make_mesher(options));
  auto proposed = pmc();
  testing::add_all(*classical, scan.lines);
  testing::add_all(*proposed, scan.lines);
  EXPECT_EQ(classical->mesh().triangles, proposed->mesh().triangles);
}

}  // namespace
}  // namespace linescope
