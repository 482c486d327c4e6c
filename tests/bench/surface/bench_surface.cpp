// From points to triangles: our meshers beside one read of the same bytes and beside the peers, interleaved
// in one process on one processor, so that a busy machine slows all of them alike. Ratios are what counts.
//
//   bench_surface                   the donor site, 94,080 points (Google Benchmark's options apply)
//   bench_surface --large           also 1 and 10 million points
//   bench_surface --scan FILE       the points of a file (surface_study --write-scan) instead
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "tests/bench/one_processor.hpp"
#include "tests/bench/paired.hpp"
#include "tests/bench/surface/file_scan.hpp"
#include "tests/bench/surface/peers.hpp"
#include "tests/unit/surface/surface_phantom.hpp"

namespace linescope::bench {
namespace {

using testing::CondyleScan;
using testing::ScanPlan;

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// All points of a scan in one piece of memory, as the segment holds them.
struct Cloud {
  CondyleScan scan;
  std::vector<SurfacePoint> points;
  std::vector<SurfaceLine> lines;
};

std::shared_ptr<Cloud> cloud_of(CondyleScan scan) {
  auto cloud = std::make_shared<Cloud>();
  cloud->scan = std::move(scan);
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
  bool slow = false;  // runs in the first round only
  std::vector<double> seconds{};
  TriangleMesh result{};
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

enum class Peers { none, quick, all };

std::vector<Row> rows_for(const std::shared_ptr<Cloud>& cloud, Peers wanted) {
  std::vector<Row> rows;
  rows.push_back({"one read of the points", [cloud] { benchmark::DoNotOptimize(read_pass(cloud->points)); },
                  [] { return TriangleMesh{}; }});
  rows.push_back(own_row("implicit, quadric", cloud, {}));
  rows.push_back(own_row("implicit, plane", cloud, {.fit = LocalFit::plane}));
  rows.push_back(own_row("PMC", cloud, {.method = MeshMethod::proposed_cubes}));
  rows.push_back(own_row("CMC", cloud, {.method = MeshMethod::classical_cubes}));
  if (wanted == Peers::none) return rows;
  std::vector<Eigen::Vector3f> places;
  for (const SurfacePoint& p : cloud->points) places.push_back(p.position);
  for (const auto& peers : {vtk_peers(places, 1.27), cgal_peers(places, 1.27), pcl_peers(places, 1.27),
                            open3d_peers(places, 1.27)})
    for (const Peer& peer : peers)
      if (wanted == Peers::all || !peer.slow) rows.push_back({peer.name, peer.run, peer.mesh, peer.slow});
  return rows;
}

double least(const std::vector<double>& values) {
  return *std::min_element(values.begin(), values.end());
}

/// Medians, and ratios of medians and of minima: what a busy machine adds differs from row to row, the
/// minimum is what is left of it.
void report(benchmark::State& state, const Row& row, const Row& read, const Row& ours,
            const CondyleScan& scan, double stray_beyond) {
  state.counters["ms"] = 1e3 * median(row.seconds);
  state.counters["min_ms"] = 1e3 * least(row.seconds);
  state.counters["x_read"] = median(row.seconds) / median(read.seconds);
  state.counters["x_quadric"] = median(row.seconds) / median(ours.seconds);
  state.counters["min_x_read"] = least(row.seconds) / least(read.seconds);
  state.counters["min_x_quadric"] = least(row.seconds) / least(ours.seconds);
  const TriangleMesh& mesh = row.result;
  if (mesh.empty()) return;
  const auto accuracy = testing::accuracy_of(mesh, scan, 1.27, stray_beyond);
  state.counters["triangles"] = static_cast<double>(mesh.triangle_count());
  state.counters["rms_um"] = 1e3 * accuracy.rms;
  state.counters["p95_um"] = 1e3 * accuracy.p95;
  state.counters["mean_um"] = 1e3 * accuracy.mean;
  state.counters["sd_um"] = 1e3 * accuracy.deviation;
  state.counters["rms_all_um"] = 1e3 * testing::rms_of_all(mesh, scan, 1.27);
  state.counters["stray"] = static_cast<double>(accuracy.stray);
}

/// One table: every round runs every row once; slow ones in the first round only.
void measure(const std::string& title, CondyleScan scan, int rounds, Peers peers, double stray_beyond = 1.0) {
  const auto cloud = cloud_of(std::move(scan));
  auto rows = std::make_shared<std::vector<Row>>(rows_for(cloud, peers));
  for (Row& row : *rows)
    if (!row.slow) row.run();
  for (int round = 0; round < rounds; ++round)
    for (Row& row : *rows) {
      if (row.slow && round > 0) continue;
      const double begin = seconds_now();
      row.run();
      row.seconds.push_back(seconds_now() - begin);
      if (round == 0) row.result = row.mesh();
    }
  for (std::size_t i = 0; i < rows->size(); ++i)
    benchmark::RegisterBenchmark((title + "/" + (*rows)[i].name).c_str(),
                                 [=](benchmark::State& state) {
                                   for (auto _ : state) state.SetIterationTime(median((*rows)[i].seconds));
                                   report(state, (*rows)[i], (*rows)[0], (*rows)[1], cloud->scan,
                                          stray_beyond);
                                 })
        ->Iterations(1)
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond);
}

/// A mesher that holds part of a scan, and what its next lines cost, mesh up to date after each.
struct GrowingMesh {
  std::size_t points = 0;  // before the timed lines
  std::unique_ptr<Mesher> mesher;
  std::size_t next = 0;  // line
  std::vector<double> seconds{};

  void take(const Cloud& cloud) {
    const double begin = seconds_now();
    mesher->add_line(cloud.lines[next++]);
    mesher->update();
    seconds.push_back(seconds_now() - begin);
  }
};

GrowingMesh grown(const Cloud& cloud, double points, const MesherOptions& options) {
  GrowingMesh mesh{.mesher = std::move(*make_mesher(options))};
  while (static_cast<double>(mesh.points) < points) {
    mesh.points += cloud.lines[mesh.next].points.size();
    mesh.mesher->add_line(cloud.lines[mesh.next++]);
  }
  mesh.mesher->update();
  return mesh;
}

double copy_seconds(Mesher& mesher) {
  TriangleMesh mesh;
  std::vector<double> seconds;
  for (int i = 0; i < 7; ++i) {
    const double begin = seconds_now();
    mesher.write_mesh(mesh);
    seconds.push_back(seconds_now() - begin);
  }
  return median(seconds);
}

void report(benchmark::State& state, const GrowingMesh& mesh, const GrowingMesh& smallest) {
  const auto quantile = [](std::vector<double> v, double share) {
    std::sort(v.begin(), v.end());
    return v[static_cast<std::size_t>(share * static_cast<double>(v.size() - 1))];
  };
  const MesherState held = mesh.mesher->state();
  state.counters["points_before"] = static_cast<double>(mesh.points);
  state.counters["us"] = 1e6 * median(mesh.seconds);
  state.counters["p99_us"] = 1e6 * quantile(mesh.seconds, 0.99);
  state.counters["x_smallest"] = median(mesh.seconds) / median(smallest.seconds);
  state.counters["quartile_x_smallest"] = quantile(mesh.seconds, 0.25) / quantile(smallest.seconds, 0.25);
  state.counters["copy_us"] = 1e6 * copy_seconds(*mesh.mesher);
  state.counters["cubes"] = static_cast<double>(held.occupied_cells);
  state.counters["bytes_per_cube"] =
      static_cast<double>(held.memory_bytes) / static_cast<double>(held.occupied_cells);
}

/// Cost of one line when so many points came before, the sizes in turn, line by line: a busy machine is as
/// busy for the small ones as for the large.
void measure_growth(const std::string& title, const ScanPlan& plan, const std::vector<double>& sizes,
                    const MesherOptions& options) {
  constexpr int kLines = 147;
  const auto cloud = cloud_of(testing::scan_condyle(plan));
  const auto meshes = std::make_shared<std::vector<GrowingMesh>>();
  for (const double size : sizes) meshes->push_back(grown(*cloud, size, options));
  for (int line = 0; line < kLines; ++line)
    for (GrowingMesh& mesh : *meshes) mesh.take(*cloud);
  for (std::size_t i = 0; i < meshes->size(); ++i)
    benchmark::RegisterBenchmark(
        (title + "/one line more after " + std::to_string((*meshes)[i].points)).c_str(),
        [=](benchmark::State& state) {
          for (auto _ : state) state.SetIterationTime(median((*meshes)[i].seconds));
          report(state, (*meshes)[i], meshes->front());
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

void register_phantoms(bool large) {
  constexpr double kSmall = 1e4, kSite = 9e4;
  const MesherOptions implicit, pmc{.method = MeshMethod::proposed_cubes};
  measure("94k", testing::scan_condyle(area(147, 1, 1)), 15, Peers::all);
  measure_growth("implicit", area(300, 1, 1), {kSmall, kSite}, implicit);
  measure_growth("PMC", area(300, 1, 1), {kSmall, kSite}, pmc);
  if (!large) return;
  measure("1M", testing::scan_condyle(area(521, 3, 1)), 7, Peers::quick);
  measure("10M area", testing::scan_condyle(area(1563, 10, 1)), 5, Peers::none);
  measure("10M dense", testing::scan_condyle(area(147, 1, 106)), 5, Peers::none);
  measure_growth("area/implicit", area(1563, 10, 1), {1e4, 1e5, 1e6, 9.9e6}, implicit);
  measure_growth("area/PMC", area(1563, 10, 1), {1e4, 1e5, 1e6, 9.9e6}, pmc);
  measure_growth("dense/implicit", area(147, 1, 106), {1e4, 1e5, 1e6, 9.8e6}, implicit);
}

/// Takes an option of our own out of the command line; its value, or nothing.
std::optional<std::string> taken_option(int& argc, char** argv, std::string_view name, bool with_value) {
  const auto at = std::find(argv + 1, argv + argc, name);
  const std::ptrdiff_t length = with_value ? 2 : 1;
  if (argv + argc - at < length) return std::nullopt;
  const std::string value = at[length - 1];
  std::move(at + length, argv + argc, at);
  argc -= static_cast<int>(length);
  return value;
}

}  // namespace
}  // namespace linescope::bench

int main(int argc, char** argv) {
  using namespace linescope::bench;
  const bool large = taken_option(argc, argv, "--large", false).has_value();
  const auto file = taken_option(argc, argv, "--scan", true);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  pin_to_this_processor();
  if (file) {
    auto scan = scan_from_file(*file);
    if (!scan) return std::fprintf(stderr, "bench_surface: %s\n", scan.error().message.c_str()), 1;
    constexpr double kFarOff =
        2.5;  // mm: the tracker shifts the whole scan by the better part of a millimetre
    measure("file", std::move(*scan), 15, Peers::all, kFarOff);
  } else {
    register_phantoms(large);
  }
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
