// The vector forms of the hot loops against the plain ones, and the plain ones against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "tests/unit/surface/surface_phantom.hpp"
#include "viewer/surface/line_quantizer.hpp"
#include "viewer/surface/point_tile.hpp"

namespace linescope {
namespace {

LinePlacement placement() {
  LinePlacement p;
  p.low = {-10, -10, -10, 0};
  p.high = {10, 10, 10, 3};
  p.origin = {-12.7f, -12.7f, -12.7f, 0};
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

TEST(PlacePoints, TheFormInUseEqualsThePlainOneBitForBit) {
  for (const std::size_t count : {1u, 2u, 3u, 7u, 640u, 641u}) {
    const auto points = mixed_points(count, count);
    std::vector<PlacedPoint> plain(count), used(count);
    const PlacedBounds a = place_points_portable(placement(), points, plain.data());
    const PlacedBounds b = place_points(placement(), points, used.data());
    EXPECT_EQ(plain, used) << count;
    EXPECT_EQ(a.refused, b.refused) << count;
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(a.low[i], b.low[i]) << count;
      EXPECT_EQ(a.high[i], b.high[i]) << count;
    }
  }
}

TEST(PlacePoints, StepsAreThoseOfDoublePrecisionToASixteenth) {
  const auto points = mixed_points(1000, 5);
  std::vector<PlacedPoint> placed(points.size());
  place_points(placement(), points, placed.data());
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (placed[i].weight == 0) continue;
    const double exact = (static_cast<double>(points[i].position.x()) + 12.7) * kSteps / 1.27;
    EXPECT_LE(placed[i].x, exact + 1.0 / 16);
    EXPECT_GE(placed[i].x, exact - 1.0 - 1.0 / 16);
  }
}

TEST(PlacePoints, AWeightIsTheInverseVarianceWithinItsLimits) {
  std::vector<SurfacePoint> points;
  for (const float sd : {0.0f, 0.26f, 0.13f, 0.52f, 0.01f, 2.9f}) points.push_back({{0, 0, 0}, 0, sd});
  std::vector<PlacedPoint> placed(points.size());
  place_points(placement(), points, placed.data());
  const std::int32_t expected[] = {4, 4, 16, 1, 16, 1};
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_EQ(placed[i].weight, expected[i]) << i;
}

bool operator==(const MomentSums& a, const MomentSums& b) {
  return a.first == b.first && a.squares == b.squares && a.products == b.products;
}

TEST(AddMoments, TheFormInUseEqualsThePlainOneAndTheDefinition) {
  const auto points = mixed_points(640, 9);
  std::vector<PlacedPoint> placed(points.size());
  const PlacedBounds bounds = place_points(placement(), points, placed.data());
  const TileBox box = box_of(bounds, 0);
  std::vector<MomentSums> plain(static_cast<std::size_t>(box.volume())), used(plain.size());
  add_moments_portable(placed, box, plain.data());
  add_moments(placed, box, used.data());
  std::int64_t count = 0, xy = 0, zz = 0, weight = 0;
  for (std::size_t i = 0; i < plain.size(); ++i) {
    EXPECT_TRUE(plain[i] == used[i]) << i;
    count += used[i].points();
    weight += used[i].weight();
    xy += used[i].products[0];
    zz += used[i].squares[2];
  }
  std::int64_t expected_xy = 0, expected_zz = 0, expected_weight = 0;
  for (const PlacedPoint& p : placed) {
    const std::int64_t x = p.x % kSteps, y = p.y % kSteps, z = p.z % kSteps;
    expected_xy += p.weight * x * y;
    expected_zz += p.weight * z * z;
    expected_weight += p.weight;
  }
  EXPECT_EQ(count, static_cast<std::int64_t>(placed.size() - bounds.refused));
  EXPECT_EQ(weight, expected_weight);
  EXPECT_EQ(xy, expected_xy);
  EXPECT_EQ(zz, expected_zz);
}

TEST(ForEachTile, WildPointsSplitTheLineAndLoseNothing) {
  testing::Noise noise(3);
  std::vector<SurfacePoint> points(640, SurfacePoint{{0, 0, 0}, 0, 0});
  for (std::size_t i = 0; i < points.size(); i += 9)
    points[i].position =
        Eigen::Vector3d(20 * noise.uniform() - 10, 20 * noise.uniform() - 10, 20 * noise.uniform() - 10)
            .cast<float>();
  std::vector<PlacedPoint> placed(points.size());
  LinePlacement fine = placement();
  fine.steps_per_mm = kSteps / 0.2f;
  const PlacedBounds bounds = place_points(fine, points, placed.data());
  ASSERT_GT(box_of(bounds, 0).volume(), kMaxTile);
  std::vector<MomentSums> tile(kMaxTile);
  std::int64_t count = 0;
  for_each_tile(placed, bounds, 0, [&](std::span<const PlacedPoint> part, const TileBox& box) {
    ASSERT_LE(box.volume(), kMaxTile);
    std::fill(tile.begin(), tile.end(), MomentSums{});
    add_moments(part, box, tile.data());
    for (const auto& sums : tile) count += sums.points();
  });
  EXPECT_EQ(count, static_cast<std::int64_t>(points.size() - bounds.refused));
}

}  // namespace
}  // namespace linescope
