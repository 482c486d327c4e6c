// Navigation against its peers on the same points, tip by tip in turn, so that a busy machine hits all alike
// (T13, T15).
//
// bench_neighbourhoods.cpp compares errors at every neighbourhood size, bench_triangles.cpp is T14.
//
// Every benchmark reports counters: medians in microseconds, ratios of medians, mean errors in degrees. Only
// the ratios are fit to be compared between machines.
#include <benchmark/benchmark.h>

#include <atomic>
#include <thread>

#include "tests/bench/navigate/bench_world.hpp"
#include "tests/bench/navigate/normal_peers.hpp"

namespace linescope::bench {
namespace {

World& world(bool large) {
  static World small(false, {.point = 0.26, .drift = 0});
  if (!large) return small;
  static World big(true, {.point = 0.26, .drift = 0});
  return big;
}

std::optional<Eigen::Vector3d> normal_of(const std::optional<FittedPlane>& plane) {
  return plane ? std::optional<Eigen::Vector3d>(plane->normal) : std::nullopt;
}

void normals(benchmark::State& state) {
  World& w = world(state.range(0) == 1);
  const std::unique_ptr<NormalPeer> tree = nanoflann_peer(w.points);
  Tally plain, robust, small, large;
  for (auto _ : state)
    for (const PlacedSpot& spot : w.spots) {
      const Eigen::Vector3d& tip = spot.query.tip;
      plain.time([&] { return normal_of(w.estimator.plane_near(tip)); }, spot.true_normal);
      small.time([&] { return tree->normal(tip, 1.27); }, spot.true_normal);
      robust.time(
          [&] {
            const NormalEstimate e = w.estimator.estimate(spot.query);
            return e.good() ? std::optional<Eigen::Vector3d>(e.normal) : std::nullopt;
          },
          spot.true_normal);
      large.time([&] { return tree->normal(tip, 2.0); }, spot.true_normal);
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
  state.counters["robust_processor_p99_us"] = percentile(robust.processor_times, 0.99);
  state.counters["robust_processor_p99_of_period"] = percentile(robust.processor_times, 0.99) / (1e6 / 240);
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
}  // namespace linescope::bench

BENCHMARK_MAIN();
