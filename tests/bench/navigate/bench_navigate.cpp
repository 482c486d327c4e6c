// Navigation against its peers on the same points, tip by tip in turn, so that a busy machine hits all alike
// (T13, T14, T15).
//
// Every benchmark reports counters: medians in microseconds, ratios of medians, mean errors in degrees. Only
// the ratios are fit to be compared between machines.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <nanoflann.hpp>
#include <thread>

#include "tests/unit/navigate/phantoms.hpp"
#include "viewer/navigate/angle_difference.hpp"
#include "viewer/navigate/moments.hpp"

namespace linescope {
namespace {

using namespace phantom;

double microseconds() {
  return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const auto place =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

/// A condyle patch scanned at 376 points / mm^2 with white noise of 0.26 mm; 1M: three swaths on a larger
/// ellipsoid.
struct World {
  explicit World(bool large) {
    const double scale = large ? 3.54 : 1.0;
    surface =
        ellipsoid("condyle", 25 * scale, 22 * scale, 25 * scale, large ? 44.3 : 12.5, large ? 15.0 : 5.0);
    Scanner scanner(12345);
    scanner.sweep(surface, {.points_per_line = large ? 1920 : 640}, {.point = 0.26, .drift = 0}, 0, scan);
    add_all(estimator, scan);
    for (const ScannedLine& line : scan)
      for (const SurfacePoint& p : line.points) points.push_back(p.position);
    for (int i = 0; i < 2000; ++i)
      spots.push_back(spot_at(surface, scanner.uniform(-1, 1) * (surface.half_length - 3),
                              scanner.uniform(-1, 1) * (surface.half_width - 3), 0.05, i,
                              scanner.uniform(0, 1)));
  }
  Surface surface;
  Scan scan;
  NormalEstimator estimator;
  std::vector<Eigen::Vector3f> points;
  std::vector<PlacedSpot> spots;
};

World& world(bool large) {
  static World small(false);
  if (!large) return small;
  static World big(true);
  return big;
}

struct Adaptor {
  const std::vector<Eigen::Vector3f>& points;
  std::size_t kdtree_get_point_count() const { return points.size(); }
  float kdtree_get_pt(std::size_t i, std::size_t d) const { return points[i][static_cast<Eigen::Index>(d)]; }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

class Nanoflann {
 public:
  explicit Nanoflann(const std::vector<Eigen::Vector3f>& points)
      : adaptor_{points}, tree_(3, adaptor_, nanoflann::KDTreeSingleIndexAdaptorParams(10)) {
    tree_.buildIndex();
  }
  std::optional<FittedPlane> plane(const Eigen::Vector3d& tip, double radius) {
    const Eigen::Vector3f q = tip.cast<float>();
    nanoflann::SearchParams parameters;
    parameters.sorted = false;
    tree_.radiusSearch(q.data(), static_cast<float>(radius * radius), found_, parameters);
    Moments sum;
    for (const auto& match : found_) sum.add((adaptor_.points[match.first] - q).cast<double>());
    return plane_through(sum);
  }

 private:
  Adaptor adaptor_;
  nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Adaptor>, Adaptor, 3, std::uint32_t>
      tree_;
  std::vector<std::pair<std::uint32_t, float>> found_;
};

double error_of(const Eigen::Vector3d& normal, const Eigen::Vector3d& truth) {
  const double angle = angle_difference(normal, truth);
  return degrees_from_radians(std::min(angle, M_PI - angle));
}

struct Tally {
  std::vector<double> times;
  double error = 0;
  int answered = 0;
  template <class Ask>
  void time(Ask&& ask, const Eigen::Vector3d& truth) {
    const double start = microseconds();
    const auto normal = ask();
    times.push_back(microseconds() - start);
    if (!normal) return;
    error += error_of(*normal, truth);
    ++answered;
  }
  double median() const { return percentile(times, 0.5); }
  double mean_error() const { return error / std::max(answered, 1); }
};

std::optional<Eigen::Vector3d> normal_of(const std::optional<FittedPlane>& plane) {
  return plane ? std::optional<Eigen::Vector3d>(plane->normal) : std::nullopt;
}

void normals(benchmark::State& state) {
  World& w = world(state.range(0) == 1);
  Nanoflann tree(w.points);
  Tally plain, robust, small, large;
  for (auto _ : state)
    for (const PlacedSpot& spot : w.spots) {
      const Eigen::Vector3d& tip = spot.query.tip;
      plain.time([&] { return normal_of(w.estimator.plane_near(tip)); }, spot.true_normal);
      small.time([&] { return normal_of(tree.plane(tip, 1.27)); }, spot.true_normal);
      robust.time(
          [&] {
            const NormalEstimate e = w.estimator.estimate(spot.query);
            return e.good() ? std::optional<Eigen::Vector3d>(e.normal) : std::nullopt;
          },
          spot.true_normal);
      large.time([&] { return normal_of(tree.plane(tip, 2.0)); }, spot.true_normal);
    }
  state.counters["points"] = static_cast<double>(w.points.size());
  state.counters["plain_us"] = plain.median();
  state.counters["plain_deg"] = plain.mean_error();
  state.counters["nf127_us"] = small.median();
  state.counters["nf127_deg"] = small.mean_error();
  state.counters["T13_faster"] = small.median() / plain.median();
  state.counters["T13_error"] = plain.mean_error() / small.mean_error();
  state.counters["robust_us"] = robust.median();
  state.counters["robust_p99_us"] = percentile(robust.times, 0.99);
  state.counters["robust_deg"] = robust.mean_error();
  state.counters["nf200_us"] = large.median();
  state.counters["nf200_deg"] = large.mean_error();
  state.counters["robust_over_nf200"] = robust.median() / large.median();
}
BENCHMARK(normals)->Arg(0)->Arg(1)->Iterations(2)->Unit(benchmark::kMillisecond);

/// T15 without the waking up: queries at 240 Hz pace are not needed to see whether an insertion makes one
/// wait.
void queries_beside_insertions(benchmark::State& state) {
  World& w = world(false);
  NormalEstimator estimator;
  add_all(estimator, w.scan);
  std::atomic<bool> stop = false;
  std::jthread writer([&] {
    while (!stop)
      for (const ScannedLine& line : w.scan) {
        if (stop) break;
        estimator.add_line(line.as_line());
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
      }
  });
  std::vector<double> query, empty;
  for (auto _ : state)
    for (const PlacedSpot& spot : w.spots) {
      const double a = microseconds();
      benchmark::DoNotOptimize(estimator.plane_near(spot.query.tip));
      const double b = microseconds();
      std::atomic_signal_fence(std::memory_order_seq_cst);
      const double c = microseconds();
      query.push_back(b - a);
      empty.push_back(c - b);
    }
  stop = true;
  const double period = 1e6 / 240;
  state.counters["p999_us"] = percentile(query, 0.999);
  state.counters["clock_p999_us"] = percentile(empty, 0.999);
  state.counters["T15_share"] = (percentile(query, 0.999) - percentile(empty, 0.999)) / period;
}
BENCHMARK(queries_beside_insertions)->Iterations(5)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace linescope

BENCHMARK_MAIN();
