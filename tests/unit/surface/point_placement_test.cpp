// The vector forms of the hot loops against the plain ones, and the plain ones against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <vector>

#include "tests/unit/surface/surface_phantom.hpp"
#include "viewer/surface/moment_grid.hpp"
#include "viewer/surface/point_tile.hpp"

namespace linescope {
namespace {

LinePlacement placement() {
  LinePlacement p;
  p.low = {-10, -10, -10, 0};
  p.high = {10, 10, 10, 3};
  p.origin = {-12.7f, -12.7f, -12.7f};
  p.steps_per_mm = static_cast<float>(kSteps / 1.27);
  p.weight_scale = static_cast<float>(kTypicalWeight * 0.26 * 0.26);
  return p;
}

std::vector<SurfacePoint> mixed_points(std::size_t count, std::uint64_t seed) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  testing::Noise noise(seed);
  std::vector<SurfacePoint> points(count);
  for (auto& p : points) {
    const auto value = [&] { return static_cast<float>(24 * noise.uniform() - 12); };
    p = {{value(), value(), value()}, 100, static_cast<float>(3.2 * noise.uniform() * noise.uniform())};
    const int fault = static_cast<int>(noise.uniform() * 40);
    if (fault < 3) p.position[fault] = nan;
    if (fault == 3) p.position.y() = inf;
    if (fault == 4) p.standard_deviation = nan;
    if (fault == 5) p.standard_deviation = -1;
    if (fault < 20 && fault > 5) p.standard_deviation = 0;
  }
  return points;
}

std::vector<PlacedBlock> placed_blocks(const std::vector<SurfacePoint>& points, double interval = 1.27) {
  std::vector<PlacedBlock> blocks(blocks_for(points.size()));
  LinePlacement coarse = placement();
  coarse.steps_per_mm = static_cast<float>(kSteps / interval);
  place_points(coarse, points, blocks.data());
  return blocks;
}

struct PlacedPoint {
  std::int64_t x, y, z, weight;
};
std::vector<PlacedPoint> one_by_one(const std::vector<PlacedBlock>& blocks) {
  std::vector<PlacedPoint> points;
  for (const PlacedBlock& b : blocks)
    for (std::size_t i = 0; i < kPlacedPoints; ++i) points.push_back({b.x[i], b.y[i], b.z[i], b.weight[i]});
  return points;
}

TEST(PlacePoints, TheFormInUseEqualsThePlainOneBitForBit) {
  for (const std::size_t count : {1u, 2u, 3u, 7u, 8u, 9u, 15u, 16u, 17u, 24u, 640u, 641u}) {
    const auto points = mixed_points(count, count);
    // What the blocks held before must not show through where the last one has no points.
    PlacedBlock before;
    for (auto* row : {&before.x, &before.y, &before.z, &before.weight}) row->fill(77);
    std::vector<PlacedBlock> plain(blocks_for(count), before), used(blocks_for(count), before);
    const PlacedBounds a = place_points_portable(placement(), points, plain.data());
    const PlacedBounds b = place_points(placement(), points, used.data());
    EXPECT_EQ(plain, used) << count;
    EXPECT_EQ(a, b) << count;
    EXPECT_EQ(a, bounds_of(plain)) << count;
  }
}

TEST(PlacePoints, NothingUsableIsNoPlace) {
  const std::vector<SurfacePoint> wild(20, SurfacePoint{{1e9f, 0, 0}, 0, 0});
  std::vector<PlacedBlock> blocks(blocks_for(wild.size()));
  EXPECT_EQ(place_points(placement(), wild, blocks.data()).usable, 0u);
  for (const PlacedBlock& block : blocks) EXPECT_EQ(block, PlacedBlock{});
}

TEST(PlacePoints, StepsAreThoseOfDoublePrecisionToASixteenth) {
  const auto points = mixed_points(1000, 5);
  const auto placed = one_by_one(placed_blocks(points));
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (placed[i].weight == 0) continue;
    const double exact = (static_cast<double>(points[i].position.x()) + 12.7) * kSteps / 1.27;
    EXPECT_LE(static_cast<double>(placed[i].x), exact + 1.0 / 16);
    EXPECT_GE(static_cast<double>(placed[i].x), exact - 1.0 - 1.0 / 16);
  }
}

TEST(PlacePoints, AWeightIsTheInverseVarianceWithinItsLimits) {
  std::vector<SurfacePoint> points;
  for (const float sd : {0.0f, 0.26f, 0.13f, 0.52f, 0.01f, 2.9f, -0.0f, 1e-30f})
    points.push_back({{0, 0, 0}, 0, sd});
  const auto placed = one_by_one(placed_blocks(points));
  const std::int32_t expected[] = {4, 4, 16, 1, 16, 1, 4, 16};
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_EQ(placed[i].weight, expected[i]) << i;
}

// By the definition, from single points.
std::map<int, MomentSums> defined_sums(const std::vector<PlacedBlock>& blocks, const TileBox& box) {
  std::map<int, MomentSums> cubes;
  for (const auto& [px, py, pz, w] : one_by_one(blocks)) {
    if (w == 0) continue;
    const auto cell = [](std::int64_t steps) { return static_cast<std::int32_t>(steps / kSteps); };
    MomentSums& sums = cubes[box.index_of({cell(px), cell(py), cell(pz)})];
    const std::int64_t x = px % kSteps, y = py % kSteps, z = pz % kSteps;
    MomentSums point;
    point.first = {w * x, w * y, w * z, w};
    point.squares = {w * x * x, w * y * y, w * z * z, 1};
    point.products = {w * x * y, w * y * z, w * z * x, 1};
    sums.add(point);
  }
  return cubes;
}

std::map<int, MomentSums> by_place(std::span<const MomentTile::Cube> cubes) {
  std::map<int, MomentSums> result;
  for (const auto& cube : cubes) EXPECT_TRUE(result.emplace(cube.place, cube.sums).second) << "listed twice";
  return result;
}

TEST(MomentTile, TheFormInUseEqualsThePlainOneAndTheDefinition) {
  MomentTile tile, plain_tile;
  for (const std::size_t count : {1u, 15u, 16u, 17u, 640u, 1008u}) {
    const auto points = mixed_points(count, 9 + count);
    const auto blocks = placed_blocks(points, 2.54);
    const PlacedBounds bounds = bounds_of(blocks);
    if (bounds.usable == 0) continue;
    const TileBox box = box_of(bounds, 0);
    ASSERT_LE(box.volume(), kMaxTile);
    const auto expected = defined_sums(blocks, box);
    EXPECT_TRUE(by_place(tile.sums(blocks, box)) == expected) << count;
    EXPECT_TRUE(by_place(plain_tile.sums_portable(blocks, box)) == expected) << count;
  }
}

// Every point at the corner of its cube that is farthest from the middle, with the largest weight, and as
// many as a batch holds, all in one cube: the largest sums there can be.
TEST(MomentTile, TheLargestSumsDoNotOverflow) {
  for (const std::int32_t within : {0, kSteps - 1}) {
    PlacedBlock block;
    for (auto* row : {&block.x, &block.y, &block.z}) row->fill(5 * kSteps + within);
    block.weight.fill(kMaxPointWeight);
    const std::vector<PlacedBlock> batch(MomentTile::kBatch, block);
    const TileBox box = box_of(bounds_of(batch), 0);
    MomentTile tile;
    const auto cubes = tile.sums(batch, box);
    ASSERT_EQ(cubes.size(), 1u);
    EXPECT_TRUE(by_place(cubes) == defined_sums(batch, box)) << within;
  }
}

// More points than a batch takes: the cubes that several batches touch add up, and are one line's.
TEST(MomentGrid, ALineOfManyBatchesIsOneLine) {
  const auto blocks = placed_blocks(mixed_points(5000, 33), 2.54);
  const PlacedBounds bounds = bounds_of(blocks);
  const TileBox box = box_of(bounds, 0);
  MomentGrid grid(2.54, std::size_t{1} << 30);
  grid.begin_sweep();
  EXPECT_EQ(grid.add_line({blocks, bounds, {}}, {0, 0, 100}), bounds.usable);
  const auto expected = defined_sums(blocks, box);
  ASSERT_EQ(grid.occupied(), expected.size());
  for (std::size_t i = 0; i < grid.cell_count(); ++i) {
    const MomentCell& cell = grid.cell(static_cast<std::int32_t>(i));
    EXPECT_EQ(cell.content.lines, 1);
    EXPECT_TRUE(cell.content.sums == expected.at(box.index_of(cell.at)));
  }
  // Taking it back leaves nothing, and what comes then is new.
  EXPECT_EQ(grid.remove_last_sweep(), static_cast<std::int64_t>(bounds.usable));
  EXPECT_EQ(grid.occupied(), 0u);
  grid.begin_sweep();
  EXPECT_EQ(grid.add_line({blocks, bounds, {}}, {0, 0, 100}), bounds.usable);
  EXPECT_EQ(grid.occupied(), expected.size());
}

TEST(CountPoints, TheFormInUseEqualsThePlainOne) {
  const auto blocks = placed_blocks(mixed_points(641, 21), 2.54);
  for (const std::int32_t shift : {0, kSteps / 2}) {
    const PlacedBounds bounds = bounds_of(blocks);
    const TileBox box = box_of(bounds, shift);
    ASSERT_LE(box.volume(), kMaxTile);
    std::vector<std::uint32_t> plain(kMaxTile), used(kMaxTile);
    count_points_portable(blocks, shift, box, plain.data());
    count_points(blocks, shift, box, used.data());
    EXPECT_EQ(plain, used);
    EXPECT_EQ(std::accumulate(used.begin(), used.end(), std::size_t{0}), bounds.usable);
  }
}

TEST(ForEachTile, WildPointsSplitTheLineAndLoseNothing) {
  testing::Noise noise(3);
  std::vector<SurfacePoint> points(640, SurfacePoint{{0, 0, 0}, 0, 0});
  for (std::size_t i = 0; i < points.size(); i += 9)
    points[i].position =
        Eigen::Vector3d(20 * noise.uniform() - 10, 20 * noise.uniform() - 10, 20 * noise.uniform() - 10)
            .cast<float>();
  std::vector<PlacedBlock> placed(blocks_for(points.size()));
  LinePlacement fine = placement();
  fine.steps_per_mm = kSteps / 0.2f;
  const PlacedBounds bounds = place_points(fine, points, placed.data());
  ASSERT_GT(box_of(bounds, 0).volume(), kMaxTile);
  MomentTile tile;
  std::int64_t count = 0;
  for_each_tile(placed, bounds, 0, [&](std::span<const PlacedBlock> part, const TileBox& box) {
    ASSERT_LE(box.volume(), kMaxTile);
    for (const auto& cube : tile.sums(part, box)) count += cube.sums.points();
  });
  EXPECT_EQ(count, static_cast<std::int64_t>(bounds.usable));
}

}  // namespace
}  // namespace linescope
