// Error and time per query of our estimate and of its peers, at every neighbourhood size, on the same points,
// tip by tip in turn. Ours is held to the same radius as the peers.
#include <benchmark/benchmark.h>

#include "tests/bench/navigate/bench_world.hpp"
#include "tests/bench/navigate/normal_peers.hpp"

namespace linescope::bench {
namespace {

/// 0: every point by itself; 1: the thesis's, lines share their poses' errors.
World& world(std::int64_t kind) {
  static World white(false, {.point = 0.26, .drift = 0});
  static World shared(false, thesis_noise());
  return kind == 0 ? white : shared;
}

NormalEstimatorOptions held_to(double radius) {
  NormalEstimatorOptions options;
  options.robust.radius = options.robust.smallest_radius = radius;
  return options;
}

/// Noise kind, radius in hundredths of a millimetre.
void neighbourhood(benchmark::State& state) {
  World& w = world(state.range(0));
  const double radius = 0.01 * static_cast<double>(state.range(1));
  NormalEstimator estimator(held_to(radius));
  add_all(estimator, w.scan);
  const auto peers = all_peers(w.points);
  std::vector<Tally> tallies(peers.size());
  Tally ours;
  for (auto _ : state)
    for (std::size_t i = 0; i < w.spots.size(); i += 5) {
      const PlacedSpot& spot = w.spots[i];
      ours.time(
          [&]() -> std::optional<Eigen::Vector3d> {
            const NormalEstimate e = estimator.estimate(spot.query);
            if (!e.good()) return std::nullopt;
            return e.normal;
          },
          spot.true_normal);
      for (std::size_t p = 0; p < peers.size(); ++p)
        tallies[p].time([&] { return peers[p]->normal(spot.query.tip, radius); }, spot.true_normal);
    }
  state.counters["ours_deg"] = ours.mean_error();
  state.counters["ours_us"] = ours.median();
  state.counters["ours_answered"] = static_cast<double>(ours.answered) / ours.asked;
  for (std::size_t p = 0; p < peers.size(); ++p) {
    state.counters[peers[p]->name() + "_deg"] = tallies[p].mean_error();
    state.counters[peers[p]->name() + "_us"] = tallies[p].median();
  }
}
BENCHMARK(neighbourhood)
    ->ArgsProduct({{0, 1}, {127, 200, 300, 450}})
    ->ArgNames({"shared_errors", "radius_hundredths"})
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace linescope::bench
