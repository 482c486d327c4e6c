#include <gtest/gtest.h>

#include <random>

#include "viewer/navigate/row_sums.hpp"
#include "viewer/navigate/triangle_locator.hpp"

namespace linescope {
namespace {

using Eigen::Vector3f;

TriangleMesh bumpy_mesh(int n, float step) {
  TriangleMesh mesh;
  for (int y = 0; y <= n; ++y)
    for (int x = 0; x <= n; ++x)
      mesh.positions.emplace_back(step * float(x), step * float(y),
                                  std::sin(0.7f * float(x)) * std::cos(0.5f * float(y)));
  const auto at = [n](int x, int y) { return static_cast<std::uint32_t>(y * (n + 1) + x); };
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      mesh.triangles.push_back({at(x, y), at(x + 1, y), at(x, y + 1)});
      mesh.triangles.push_back({at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)});
    }
  return mesh;
}

/// Independent of the locator's way: the smallest distance over a fine sampling of all triangles.
float sampled_distance(const TriangleMesh& mesh, const Vector3f& p) {
  float best = 1e30f;
  for (const auto& t : mesh.triangles)
    for (int i = 0; i <= 20; ++i)
      for (int j = 0; i + j <= 20; ++j) {
        const float u = float(i) / 20, v = float(j) / 20;
        const Vector3f q =
            (1 - u - v) * mesh.positions[t[0]] + u * mesh.positions[t[1]] + v * mesh.positions[t[2]];
        best = std::min(best, (q - p).squaredNorm());
      }
  return std::sqrt(best);
}

/// Corners at random, some with two or three of them in one place or on one line.
std::vector<std::array<Vector3f, 3>> random_triangles(std::mt19937& random, int count) {
  std::normal_distribution<float> normal;
  std::vector<std::array<Vector3f, 3>> triangles;
  for (int i = 0; i < count; ++i) {
    std::array<Vector3f, 3> t;
    for (Vector3f& corner : t) corner = {normal(random), normal(random), normal(random)};
    if (i % 10 == 7) t[1] = t[0];
    if (i % 10 == 8) t[2] = 0.5f * (t[0] + t[1]);
    if (i % 10 == 9) t[1] = t[2] = t[0];
    triangles.push_back(t);
  }
  return triangles;
}

TEST(TriangleBatch, FindsTheNearestOfEightWithAndWithoutVectorRegisters) {
  std::mt19937 random(4);
  std::normal_distribution<float> normal;
  for (int round = 0; round < 200; ++round) {
    const auto triangles = random_triangles(random, 1 + round % 8);
    TriangleBatch batch;
    TriangleMesh mesh;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      const auto& [a, b, c] = triangles[i];
      batch.put(static_cast<int>(i), a, b - a, c - a, static_cast<std::int32_t>(i));
      const auto first = static_cast<std::uint32_t>(mesh.positions.size());
      mesh.positions.insert(mesh.positions.end(), {a, b, c});
      mesh.triangles.push_back({first, first + 1, first + 2});
    }
    const Vector3f place(normal(random), normal(random), 2 * normal(random));
    float best = 1e6f, portable_best = 1e6f;
    const int lane = nearer_lane(batch, place, best);
    ASSERT_GE(lane, 0);
    ASSERT_LT(lane, static_cast<int>(triangles.size())) << "an empty lane is never the nearest";
    ASSERT_NE(nearer_lane_portable(batch, place, portable_best), TriangleBatch::kNoLane);
    EXPECT_NEAR(std::sqrt(best), std::sqrt(portable_best), 1e-5f);
    const float sampled = sampled_distance(mesh, place);
    EXPECT_LE(std::sqrt(best), sampled + 1e-4f);
    float longest = 0;
    for (const auto& [a, b, c] : triangles)
      longest = std::max({longest, (b - a).norm(), (c - a).norm(), (c - b).norm()});
    EXPECT_GE(std::sqrt(best), sampled - longest / 20);  // samples are that far apart
    EXPECT_EQ(nearer_lane(batch, place, best), TriangleBatch::kNoLane)
        << "nothing is nearer than the nearest";
  }
}

TEST(TriangleLocator, IsNeverFartherThanAnySampleOfTheMesh) {
  const TriangleMesh mesh = bumpy_mesh(12, 1.0f);
  TriangleLocator locator;
  locator.assign(mesh);
  std::mt19937 random(1);
  std::uniform_real_distribution<float> xy(-3, 15), z(-4, 4);
  for (int i = 0; i < 200; ++i) {
    const Vector3f p(xy(random), xy(random), z(random));
    const auto found = locator.nearest(p);
    ASSERT_TRUE(found);
    const float sampled = sampled_distance(mesh, p);
    EXPECT_LE(found->distance, sampled + 1e-4f);
    EXPECT_GE(found->distance, sampled - 0.08f);  // samples are 0.06 mm apart at most
    EXPECT_NEAR((found->point - p).norm(), found->distance, 1e-4f);
  }
}

TEST(TriangleLocator, ReplacingKeepsItEqualToANewOne) {
  const TriangleMesh before = bumpy_mesh(10, 1.0f);
  TriangleMesh after = before;
  for (auto& p : after.positions)
    if (p.x() > 5) p.z() += 1.5f;
  TriangleLocator changed, fresh;
  changed.assign(before);
  fresh.assign(after);
  for (std::size_t i = 0; i < after.triangles.size(); ++i) {
    const auto& t = after.triangles[i];
    const TriangleLocator::Triangle triangle{after.positions[t[0]], after.positions[t[1]],
                                             after.positions[t[2]]};
    changed.replace(i, std::span(&triangle, 1));
  }
  EXPECT_EQ(changed.size(), fresh.size());
  std::mt19937 random(2);
  std::uniform_real_distribution<float> u(-1, 11);
  for (int i = 0; i < 300; ++i) {
    const Vector3f p(u(random), u(random), u(random) / 4);
    EXPECT_EQ(changed.nearest(p)->distance, fresh.nearest(p)->distance);
  }
}

TEST(TriangleLocator, SaysWhenThereIsNothing) {
  TriangleLocator locator;
  EXPECT_FALSE(locator.nearest({0, 0, 0}));
  locator.assign(bumpy_mesh(2, 1.0f));
  EXPECT_FALSE(locator.nearest({0, 0, 100}));
  EXPECT_FALSE(locator.nearest({std::nanf(""), 0, 0}));
  const TriangleLocator::Triangle bad{{0, 0, 0}, {1, 0, 0}, {0, std::nanf(""), 0}};
  const std::size_t size = locator.size();
  locator.replace(99, std::span(&bad, 1));
  EXPECT_EQ(locator.size(), size);
  locator.replace(0, {});
  EXPECT_EQ(locator.size(), size - 1);
}

TEST(RowSums, FastAndPortableWaysAgree) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  std::vector<FitRow> rows(101);
  std::vector<double> weights(101);
  for (auto& row : rows)
    for (int k = 0; k < 12; ++k) row[k] = k == 11 ? 0 : normal(random);
  for (double& w : weights) w = std::abs(normal(random));
  RowSums fast = RowSums::Zero(), portable = RowSums::Zero(), curved = RowSums::Zero(),
          curved_portable = RowSums::Zero();
  add_rows(rows.data(), weights.data(), rows.size(), fast);
  add_rows_portable(rows.data(), weights.data(), rows.size(), portable);
  add_curved_rows(rows.data(), weights.data(), rows.size(), curved);
  add_curved_rows_portable(rows.data(), weights.data(), rows.size(), curved_portable);
  for (int r = 0; r < 11; ++r)
    for (int c = 0; c <= r; ++c) {
      double direct = 0;
      for (std::size_t i = 0; i < rows.size(); ++i) direct += weights[i] * rows[i][r] * rows[i][c];
      EXPECT_NEAR(portable(r, c), direct, 1e-11);
      EXPECT_NEAR(fast(r, c), direct, 1e-11);
      EXPECT_NEAR(curved(r, c), c < 3 ? 0 : direct, 1e-11);
      EXPECT_NEAR(curved_portable(r, c), c < 3 ? 0 : direct, 1e-11);
    }
}

}  // namespace
}  // namespace linescope
