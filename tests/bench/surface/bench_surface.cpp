// From points to triangles: our meshers beside one read of the same bytes and beside the peers, interleaved
// in one process on one thread, so that a busy machine slows all of them alike. Ratios are what counts.
//
//   build/release/bin/bench_surface            the donor site, 94,080 points (Google Benchmark's options
//   apply) build/release/bin/bench_surface --large    also 1 and 10 million points, without peers
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <memory>
#include <string>

#include "tests/bench/surface/peers.hpp"
#include "tests/unit/surface/surface_phantom.hpp"

namespace linescope::bench {
namespace {

using testing::CondyleScan;
using testing::ScanPlan;

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

/// All points of a scan in one piece of memory, as the segment holds them.
struct Cloud {
  CondyleScan scan;
  std::vector<SurfacePoint> points;
  std::vector<SurfaceLine> lines;
};

std::shared_ptr<Cloud> cloud_of(const ScanPlan& plan) {
  auto cloud = std::make_shared<Cloud>();
  cloud->scan = testing::scan_condyle(plan);
  cloud->points.reserve(cloud->scan.point_count());
  for (auto& line : cloud->scan.lines) {
    cloud->points.insert(cloud->points.end(), line.points.begin(), line.points.end());
    cloud->lines.push_back({.points = {cloud->points.end().base() - line.points.size(), line.points.size()},
                            .seen_from = line.seen_from,
                            .time = line.time});
    line.points = {};
  }
  return cloud;
}

__attribute__((optimize("O3"))) std::uint64_t read_pass(std::span<const SurfacePoint> points) {
  std::uint64_t lanes[8] = {};
  const auto* bytes = reinterpret_cast<const unsigned char*>(points.data());
  const std::size_t words = points.size_bytes() / 64 * 8;
  for (std::size_t i = 0; i < words; i += 8) {
    std::uint64_t chunk[8];
    std::memcpy(chunk, bytes + 8 * i, sizeof(chunk));
    for (std::size_t k = 0; k < 8; ++k) lanes[k] ^= chunk[k];
  }
  return lanes[0] ^ lanes[1] ^ lanes[2] ^ lanes[3] ^ lanes[4] ^ lanes[5] ^ lanes[6] ^ lanes[7];
}

struct Row {
  std::string name;
  std::function<void()> run;
  std::function<TriangleMesh()> mesh;
  std::vector<double> seconds{};
};

Row own_row(const std::string& name, const std::shared_ptr<Cloud>& cloud, const MesherOptions& options) {
  const std::shared_ptr<Mesher> mesher = std::move(*make_mesher(options));
  const auto mesh = std::make_shared<TriangleMesh>();
  const auto run = [=] {
    mesher->clear();
    for (const SurfaceLine& line : cloud->lines) mesher->add_line(line);
    mesher->write_mesh(*mesh);
  };
  return {name, run, [=] { return *mesh; }};
}

std::vector<Row> rows_for(const std::shared_ptr<Cloud>& cloud, bool with_peers) {
  std::vector<Row> rows;
  rows.push_back({"one read of the points", [cloud] { benchmark::DoNotOptimize(read_pass(cloud->points)); },
                  [] { return TriangleMesh{}; }});
  rows.push_back(own_row("implicit, quadric", cloud, {}));
  rows.push_back(own_row("implicit, plane", cloud, {.fit = LocalFit::plane}));
  rows.push_back(own_row("PMC", cloud, {.method = MeshMethod::proposed_cubes}));
  rows.push_back(own_row("CMC", cloud, {.method = MeshMethod::classical_cubes}));
  if (!with_peers) return rows;
  std::vector<Eigen::Vector3f> places;
  for (const SurfacePoint& p : cloud->points) places.push_back(p.position);
  for (const auto& peers : {vtk_peers(places, 1.27), cgal_peers(places, 1.27), pcl_peers(places, 1.27),
                            open3d_peers(places, 1.27)})
    for (const Peer& peer : peers) rows.push_back({peer.name, peer.run, peer.mesh});
  return rows;
}

void report(benchmark::State& state, const Row& row, double read, double ours, const CondyleScan& scan) {
  const double seconds = median(row.seconds);
  state.counters["ms"] = 1e3 * seconds;
  state.counters["x_read"] = seconds / read;
  state.counters["x_quadric"] = seconds / ours;
  const TriangleMesh mesh = row.mesh();
  if (mesh.empty()) return;
  const auto accuracy = testing::accuracy_of(mesh, scan, 1.27);
  state.counters["triangles"] = static_cast<double>(mesh.triangle_count());
  state.counters["rms_um"] = 1e3 * accuracy.rms;
  state.counters["p95_um"] = 1e3 * accuracy.p95;
  state.counters["mean_um"] = 1e3 * accuracy.mean;
  state.counters["stray"] = static_cast<double>(accuracy.stray);
}

/// One table: every round runs every row once.
void measure(const std::string& title, const ScanPlan& plan, int rounds, bool with_peers) {
  const auto cloud = cloud_of(plan);
  auto rows = std::make_shared<std::vector<Row>>(rows_for(cloud, with_peers));
  for (Row& row : *rows) row.run();
  for (int round = 0; round < rounds; ++round)
    for (Row& row : *rows) {
      const double begin = seconds_now();
      row.run();
      row.seconds.push_back(seconds_now() - begin);
    }
  for (std::size_t i = 0; i < rows->size(); ++i)
    benchmark::RegisterBenchmark((title + "/" + (*rows)[i].name).c_str(),
                                 [=](benchmark::State& state) {
                                   for (auto _ : state) state.SetIterationTime(median((*rows)[i].seconds));
                                   report(state, (*rows)[i], median((*rows)[0].seconds),
                                          median((*rows)[1].seconds), cloud->scan);
                                 })
        ->Iterations(1)
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond);
}

/// Cost of one line when so many points came before: the mesh is brought up to date after every line.
void measure_incremental(const std::string& title, const ScanPlan& plan, const MesherOptions& options) {
  const auto cloud = cloud_of(plan);
  const std::unique_ptr<Mesher> mesher = std::move(*make_mesher(options));
  std::vector<double> seconds;
  for (const SurfaceLine& line : cloud->lines) {
    const double begin = seconds_now();
    mesher->add_line(line);
    mesher->update();
    seconds.push_back(seconds_now() - begin);
  }
  const MesherState state = mesher->state();
  std::sort(seconds.begin(), seconds.end());
  benchmark::RegisterBenchmark(
      (title + "/one line").c_str(),
      [=](benchmark::State& bench) {
        for (auto _ : bench) bench.SetIterationTime(median(seconds));
        bench.counters["us"] = 1e6 * median(seconds);
        bench.counters["p99_us"] =
            1e6 * seconds[static_cast<std::size_t>(0.99 * static_cast<double>(seconds.size() - 1))];
        bench.counters["points"] = static_cast<double>(cloud->points.size());
        bench.counters["bytes_per_cube"] =
            static_cast<double>(state.memory_bytes) / static_cast<double>(state.occupied_cells);
      })
      ->Iterations(1)
      ->UseManualTime()
      ->Unit(benchmark::kMicrosecond);
}

/// The 94k area; the same density over a larger area; the same area again and again.
ScanPlan area(int stripes, int swaths, int repeats) {
  ScanPlan plan;
  plan.stripes = stripes;
  plan.swaths = swaths;
  plan.repeats = repeats;
  return plan;
}

void register_all(bool large) {
  measure("94k", area(147, 1, 1), 15, true);
  measure_incremental("94k/implicit", area(147, 1, 1), {});
  measure_incremental("94k/PMC", area(147, 1, 1), {.method = MeshMethod::proposed_cubes});
  if (!large) return;
  measure("1M", area(521, 3, 1), 7, true);
  measure_incremental("1M/implicit", area(521, 3, 1), {});
  measure("10M area", area(1563, 10, 1), 5, false);
  measure_incremental("10M area/implicit", area(1563, 10, 1), {});
  measure("10M dense", area(147, 1, 106), 5, false);
  measure_incremental("10M dense/implicit", area(147, 1, 106), {});
}

}  // namespace
}  // namespace linescope::bench

int main(int argc, char** argv) {
  const auto large =
      std::find_if(argv + 1, argv + argc, [](const char* a) { return std::strcmp(a, "--large") == 0; });
  const bool with_large = large != argv + argc;
  if (with_large) argc = static_cast<int>(std::remove(argv + 1, argv + argc, *large) - argv);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  linescope::bench::register_all(with_large);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
