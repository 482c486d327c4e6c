// How fast the twin renders and samples. items_per_second is pictures (or samples) per second on one core; a
// camera delivers 30 pictures, a LIBERTY with three sensors 720 samples a second.
#include <benchmark/benchmark.h>

#include "acquire/twin/twin_camera.hpp"
#include "acquire/twin/twin_tracker.hpp"
#include "twin_shapes.hpp"

namespace {

using namespace linescope;
using namespace linescope::twin;

TwinOptions scanning(const char* phantom, const char* optics) {
  TwinOptions options = demo_twin();
  options.instrument = *instrument_from_name("camera-ii-320");
  options.phantom = *phantom_from_name(phantom);
  options.optics = *optics_from_name(optics);
  options.hand.scenario = Scenario::sweeps;
  return options;
}

void render(benchmark::State& state, const TwinOptions& options) {
  const auto twin = VirtualExperiment::create(options);
  if (!twin) return state.SkipWithError(twin.error().message.c_str());
  TwinCamera camera(*twin);
  if (auto started = camera.start(); !started) return state.SkipWithError(started.error().message.c_str());
  Frame frame;
  for (auto _ : state) {
    const auto pulled = camera.next(frame);
    benchmark::DoNotOptimize(pulled);
  }
  state.SetItemsProcessed(state.iterations());
}

void mesh_of_98304_triangles(benchmark::State& state, const char* optics) {
  TwinOptions options = scanning("condyle", optics);
  options.phantom.kind = PhantomKind::mesh;
  options.phantom.mesh = sphere_of_triangles(25.0, 7);
  render(state, options);
}

void track(benchmark::State& state) {
  const auto twin = VirtualExperiment::create(demo_twin());
  TwinTracker tracker(*twin);
  if (auto started = tracker.start(); !started) return state.SkipWithError(started.error().message.c_str());
  PoseSample sample;
  for (auto _ : state) {
    const auto pulled = tracker.next(sample);
    benchmark::DoNotOptimize(pulled);
  }
  state.SetItemsProcessed(state.iterations());
}

BENCHMARK_CAPTURE(render, condyle_ideal_320x240, scanning("condyle", "ideal"))->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(render, condyle_clean_320x240, scanning("condyle", "clean"))->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(render, condyle_full_320x240, scanning("condyle", "full"))->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(render, condyle_trouble_320x240, scanning("condyle", "trouble"))
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(render, mini_knee_trouble_320x240, scanning("mini-knee", "trouble"))
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(mesh_of_98304_triangles, clean_320x240, "clean")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(mesh_of_98304_triangles, trouble_320x240, "trouble")->Unit(benchmark::kMillisecond);
BENCHMARK(track)->Unit(benchmark::kMicrosecond);

}  // namespace
