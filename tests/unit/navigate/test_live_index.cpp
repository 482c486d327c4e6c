// Bookkeeping of the live index, bounded growth, and readers beside a writer.
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "tests/unit/navigate/phantoms.hpp"
#include "viewer/navigate/angle_difference.hpp"
#include "viewer/navigate/left_right.hpp"

namespace linescope {
namespace {

using namespace phantom;

TEST(CellGrid, FindsWhatItMadeAlsoWhereIndicesAreNegative) {
  CellGrid grid(1.27);
  std::vector<CellIndex> made;
  for (int i = -40; i < 40; ++i) made.emplace_back(i, 3 * i + 1, -7 * i);
  for (std::size_t i = 0; i < made.size(); ++i) EXPECT_EQ(grid.find_or_make(made[i]), static_cast<int>(i));
  for (std::size_t i = 0; i < made.size(); ++i) EXPECT_EQ(grid.find(made[i]), static_cast<int>(i));
  EXPECT_EQ(grid.find({1000, 0, 0}), CellGrid::kNone);
}

TEST(CellGrid, BoxVisitsEveryCellOnceAndNoOther) {
  CellGrid grid(1.0);
  for (int x = -12; x <= 12; ++x)
    for (int y = -12; y <= 12; ++y) grid.find_or_make({x, y, 0});
  int seen = 0;
  grid.visit_box({-9, -3, -1}, {4, 8, 1}, [&](std::int32_t number, const CellIndex& c) {
    EXPECT_EQ(grid.find(c), number);
    ++seen;
  });
  EXPECT_EQ(seen, 14 * 12);
}

TEST(LiveIndex, CountsEverything) {
  NormalEstimator estimator;
  std::vector<SurfacePoint> points(50);
  for (int i = 0; i < 50; ++i)
    points[static_cast<std::size_t>(i)].position = {0.1f * static_cast<float>(i), 0, 0};
  points[3].position.x() = std::nanf("");
  points[4].position.y() = 1e30f;
  points[20].position.z() = 3;  // wild
  estimator.add_line({1, 0, {0, 0, -1}, points});
  estimator.add_line({2, 0, {0, 0, 0}, points});  // no viewing direction
  estimator.add_line({3, 0, {0, 0, -1}, {}});
  const IndexCounts counts = estimator.counts();
  EXPECT_EQ(counts.lines, 1u);
  EXPECT_EQ(counts.lines_rejected, 2u);
  EXPECT_EQ(counts.points, 47u);
  EXPECT_EQ(counts.points_wild, 1u);
  EXPECT_EQ(counts.points_not_finite, 2u + 50u);
  estimator.clear();
  EXPECT_EQ(estimator.counts().lines + estimator.counts().points + estimator.counts().points_not_finite, 0u);
}

TEST(LiveIndex, FullIsCountedAndTheRestStays) {
  NormalEstimatorOptions options;
  options.index.cells = 1000;
  NormalEstimator estimator(options);
  Surface wide = plane();
  wide.half_length = 40;
  wide.half_width = 30;
  Scanner scanner(1);
  Scan scan;
  scanner.sweep(wide, {.step = 0.5}, {}, 0, scan);
  add_all(estimator, scan);
  EXPECT_GT(estimator.counts().points_no_room, 0u);
  EXPECT_TRUE(estimator.estimate(spot_at(wide, -35, 0, 0, 0, 0).query).good());
}

TEST(LiveIndex, RescansReplaceTheOldestAndAQueryStaysGood) {
  NormalEstimator estimator;
  Scanner scanner(2);
  for (int i = 0; i < 12; ++i) {
    Scan scan;
    scanner.sweep(condyle(), {}, {.line = 0.1}, 10.0 * i, scan);
    add_all(estimator, scan);
  }
  EXPECT_GT(estimator.counts().points_replaced, 0u);
  PlacedSpot spot = spot_at(condyle(), 0, 0, 0.1, 0, 0.5);
  spot.query.now = 130 * kSecond;
  const NormalEstimate e = estimator.estimate(spot.query);
  ASSERT_TRUE(e.good()) << name(e.reason);
  EXPECT_LT(e.age, 21 * kSecond);  // the newest sweep is in use
  EXPECT_LT(angle_difference(e.normal, spot.true_normal), radians_from_degrees(1));
}

TEST(LiveIndex, PlainNormalOfAPlaneIsExactAndPointsOut) {
  NormalEstimator estimator;
  Scanner scanner(3);
  Scan scan;
  scanner.sweep(plane(), {}, {.point = 1e-6, .drift = 0}, 0, scan);
  add_all(estimator, scan);
  const auto found = estimator.plane_near({1, 0.3, 0.4});
  ASSERT_TRUE(found);
  EXPECT_LT(angle_difference(found->normal, {0, 0, 1}), 1e-4);
  EXPECT_FALSE(estimator.plane_near({50, 0, 0}));
}

TEST(LeftRight, ReadersNeverSeeHalfAChangeAndNeverWait) {
  struct Pair {
    std::vector<int> a = std::vector<int>(64), b = std::vector<int>(64);
  };
  LeftRight<Pair> pair;
  std::atomic<bool> stop = false;
  std::atomic<int> torn = 0, reads = 0;
  std::vector<std::jthread> readers;
  for (int i = 0; i < 3; ++i)
    readers.emplace_back([&] {
      while (!stop) {
        pair.read([&](const Pair& p) { torn += p.a != p.b; });
        ++reads;
      }
    });
  while (reads < 10)
    std::this_thread::yield();  // on a busy machine the writer could be done before they begin
  for (int i = 1; i <= 3000; ++i)
    pair.write([i](Pair& p) {
      std::fill(p.a.begin(), p.a.end(), i);
      std::fill(p.b.begin(), p.b.end(), i);
    });
  stop = true;
  readers.clear();
  EXPECT_EQ(torn, 0);
  EXPECT_EQ(pair.read([](const Pair& p) { return p.a[0]; }), 3000);
}

TEST(LeftRight, AReaderAnswersWhileTheWriterIsStoppedInTheMiddleOfAChange) {
  LeftRight<int> value;
  std::atomic<bool> inside = false, go_on = false;
  std::jthread writer([&] {
    value.write([&](int& v) {
      inside = true;
      while (!go_on) std::this_thread::yield();
      v = 7;
    });
  });
  while (!inside) std::this_thread::yield();
  EXPECT_EQ(value.read([](const int& v) { return v; }), 0);  // would hang if a reader waited for the writer
  go_on = true;
  writer.join();
  EXPECT_EQ(value.read([](const int& v) { return v; }), 7);
}

TEST(LiveIndex, QueriesBesideInsertionsAreSound) {
  NormalEstimator estimator;
  Scanner scanner(4);
  Scan first, second;
  scanner.sweep(plane(), {}, {.line = 0.02}, 0, first);
  scanner.sweep(plane(), {}, {.line = 0.02}, 3, second);
  add_all(estimator, first);
  std::atomic<bool> stop = false;
  std::atomic<int> asked = 0, wrong = 0;
  std::jthread reader([&] {
    const PlacedSpot spot = spot_at(plane(), 0, 0, 0.05, 1, 0.5);
    while (!stop) {
      const NormalEstimate e = estimator.estimate(spot.query);
      wrong += !e.good() || angle_difference(e.normal, spot.true_normal) > radians_from_degrees(1.5);
      ++asked;
    }
  });
  for (const ScannedLine& line : second) estimator.add_line(line.as_line());
  while (asked == 0) std::this_thread::yield();
  stop = true;
  reader.join();
  EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace linescope
