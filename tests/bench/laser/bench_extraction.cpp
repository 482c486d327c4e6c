// Extraction of a 640x480 picture beside the limit (one read of its bytes) and beside OpenCV. See
// docs/performance-laser.md.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <opencv2/core.hpp>
#include <vector>

#include "acquire/camera/large_pages.hpp"
#include "acquire/laser/line_extractor.hpp"
#include "tests/bench/laser/peers.hpp"
#include "tests/bench/laser/read_pass.hpp"
#include "tests/bench/laser/scene.hpp"
#include "tests/bench/laser/way_table.hpp"
#include "tests/bench/one_processor.hpp"

namespace linescope::bench {
namespace {

constexpr int kFrames = 320;  // 295 MB, more than any cache here: each frame comes from memory, and lies on
                              // the pages that the daemon's frames lie on
constexpr int kDifferent = 64;
constexpr std::size_t kBytes = std::size_t{kWidth} * kHeight * 3;

LineExtractorOptions options_for(CentreMethod method) {
  LineExtractorOptions o;
  o.centre = method;
  o.colour_threshold = 40;
  return o;
}

const std::vector<cv::Mat>& frames() {
  static const std::vector<cv::Mat> all = [] {
    std::vector<cv::Mat> made(kFrames);
    for (int i = 0; i < kFrames; ++i) {
      cv::Mat& frame = made[static_cast<std::size_t>(i)];
      frame.allocator = &large_pages();
      const int first = i % (kFrames / 2);
      (first == i ? line_picture(i) : made[static_cast<std::size_t>(first)]).copyTo(frame);
    }
    return made;
  }();
  return all;
}

struct Accuracy {
  double rms = 0, bias = 0, valid = 0;
};

/// Of the estimator that fills one centre per column, over 64 frames.
template <class Estimator>
Accuracy accuracy(Estimator&& estimate) {
  std::vector<float> centre(kWidth);
  double squares = 0, sum = 0;
  int n = 0;
  for (int f = 0; f < kDifferent; ++f) {
    estimate(frames()[static_cast<std::size_t>(f)], centre);
    for (int x = 8; x < kWidth - 8; ++x) {
      const double error = static_cast<double>(centre[static_cast<std::size_t>(x)]) - line_centre(x, f);
      if (std::isnan(error)) continue;
      squares += error * error;
      sum += error;
      ++n;
    }
  }
  return {std::sqrt(squares / n), sum / n, n / (double{kDifferent} * (kWidth - 16))};
}

auto columns_of(LineExtractor& extractor) {
  return [&extractor](const cv::Mat& picture, std::vector<float>& centre) {
    std::fill(centre.begin(), centre.end(), std::nanf(""));
    for (const LineSample& s : extractor.extract(picture).samples)
      centre[static_cast<std::size_t>(s.u)] = s.v;
  };
}

void print_accuracy(const std::string& name, const Accuracy& a) {
  fmt::print("{:<52}{:>10.4f}{:>10.4f}{:>10.2f}{:>10.3f}\n", name, a.rms, a.bias, a.rms / cramer_rao_bound(),
             a.valid);
}

void extraction(benchmark::State& state) {
  pin_to_this_processor();
  cv::setNumThreads(1);
  LineExtractor plain(options_for(CentreMethod::weighted_mean)),
      refined(options_for(CentreMethod::gauss_weighted));
  HsvColumns hsv;
  Steger steger;
  std::vector<float> centre(kWidth);
  std::vector<unsigned char> copy(kBytes);
  std::size_t at = 0;
  const bool cold = state.range(0) != 0;
  const auto next = [&]() -> const cv::Mat& { return frames()[cold ? at++ % kFrames : 0]; };
  enum : std::size_t { read, copied, mean, gauss, hsv_loop, ridges };  // in ways
  std::vector<Way> ways{
      {"read every byte once", [&] { benchmark::DoNotOptimize(read_pass(next().data, kBytes)); }},
      {"memcpy",
       [&] {
         std::memcpy(copy.data(), next().data, kBytes);
         benchmark::ClobberMemory();
       }},
      {"ours, weighted mean", [&] { benchmark::DoNotOptimize(plain.extract(next()).samples.data()); }},
      {"ours, Gauss-weighted", [&] { benchmark::DoNotOptimize(refined.extract(next()).samples.data()); }},
      {"OpenCV HSV + inRange + column loop", [&] { hsv.run(next(), centre); }},
      {"OpenCV Steger (sepFilter2D)", [&] { steger.run(next(), centre); }},
  };
  for (auto _ : state) run_in_turn(ways, static_cast<int>(state.range(1)));
  print_table(cold ? "640x480, each frame from memory" : "640x480, the same frame again", ways);
  state.counters["T1 mean/read"] = ratio(ways[mean], ways[read]);
  state.counters["T2 gauss/read"] = ratio(ways[gauss], ways[read]);
  state.counters["T3 HSV/mean"] = ratio(ways[hsv_loop], ways[mean]);
  state.counters["T3 HSV/gauss"] = ratio(ways[hsv_loop], ways[gauss]);
  state.counters["T3 Steger/gauss"] = ratio(ways[ridges], ways[gauss]);
}
BENCHMARK(extraction)
    ->ArgNames({"cold", "rounds"})
    ->Args({1, 201})
    ->Args({0, 101})
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);

void centre_accuracy(benchmark::State& state) {
  LineExtractor plain(options_for(CentreMethod::weighted_mean)),
      refined(options_for(CentreMethod::gauss_weighted));
  LineExtractor standard{LineExtractorOptions{}};
  HsvColumns hsv;
  Steger steger;
  for (auto _ : state) {
    fmt::print("\naccuracy on 64 frames; Cramer-Rao bound {:.4f} px\n{:<52}{:>10}{:>10}{:>10}{:>10}\n",
               cramer_rao_bound(), "", "rms px", "bias px", "x bound", "found");
    print_accuracy("ours, weighted mean", accuracy(columns_of(plain)));
    const Accuracy gauss = accuracy(columns_of(refined));
    print_accuracy("ours, Gauss-weighted", gauss);
    print_accuracy("ours, Gauss-weighted, default thresholds", accuracy(columns_of(standard)));
    print_accuracy("OpenCV HSV + inRange + column loop",
                   accuracy([&](const cv::Mat& m, auto& c) { hsv.run(m, c); }));
    print_accuracy("OpenCV Steger (sepFilter2D)",
                   accuracy([&](const cv::Mat& m, auto& c) { steger.run(m, c); }));
    state.counters["T2 gauss rms/bound"] = gauss.rms / cramer_rao_bound();
  }
}
BENCHMARK(centre_accuracy)->Iterations(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace linescope::bench
