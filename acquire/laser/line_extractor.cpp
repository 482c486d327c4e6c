#include "acquire/laser/line_extractor.hpp"

#include <algorithm>
#include <functional>
#include <numeric>
#include <opencv2/core.hpp>
#include <span>

#include "acquire/laser/candidate_finder.hpp"
#include "acquire/laser/continuity.hpp"
#include "acquire/laser/dimness.hpp"
#include "acquire/laser/gauss_centre.hpp"
#include "acquire/laser/line_choice.hpp"
#include "acquire/laser/run_finder.hpp"

namespace linescope {
namespace {

bool usable(const cv::Mat& m) {
  const bool type = m.type() == CV_8UC3 || m.type() == CV_8UC1;
  return m.dims == 2 && type && m.cols >= 16 && m.rows >= 16 && m.cols <= 16384 && m.rows <= 16384;
}

PictureView view_of(const cv::Mat& m) {
  return {m.data, static_cast<std::ptrdiff_t>(m.step[0]), m.cols, m.rows, m.channels()};
}

/// The three-pixel means of some tens of pixels of pure noise span 2.4 times their standard deviation,
/// rarely 4.
constexpr float kMoreThanNoise = 4.5F;

/// Noise alone exceeds both sides by so much in one pixel of some ten thousand.
constexpr float kRidgeOverNoise = 4.5F;

}  // namespace

struct LineExtractor::Work {
  explicit Work(const LineExtractorOptions& o) : options(o), finder(o) {}

  void start(const cv::Mat& m);
  void find_candidates(const PictureView& picture);
  void measure(const PictureView& picture);
  void fill_sample(const Choice& choice, float centre, float peak, LineSample& sample);
  void finish();

  LineExtractorOptions options;
  RunFinder runs;
  CandidateFinder finder;
  CandidateList candidates;
  NoiseMeter noise;
  Continuity continuity;
  LineChoice choice;
  GaussCentre gauss;
  ExtractedLine line;
};

void LineExtractor::Work::start(const cv::Mat& m) {
  std::vector<LineSample> samples = std::move(line.samples);
  samples.clear();
  line = {};
  line.samples = std::move(samples);
  line.width = m.cols;
  line.height = m.rows;
  line.axis = options.axis;
  noise.clear();
}

void LineExtractor::Work::find_candidates(const PictureView& picture) {
  const int lead = leading_channel(options.colour);
  MaskRule rule = mask_rule(options, picture.channels);
  if (rule.ridge()) {
    noise.add_sparsely(picture, lead);
    rule.ridge_threshold =
        std::max(rule.ridge_threshold, static_cast<int>(std::min(254.0F, kRidgeOverNoise * noise.sigma())));
    noise.clear();
  }
  const bool shape = options.centre == CentreMethod::gauss_weighted;
  runs.find(picture, rule, options.merge_gap, fastest_marker(picture, rule), shape);
  line.crowded = runs.dropped();
  const std::array<float, 3>& scene = runs.ambient();
  const auto channel = [&](int i) { return scene[static_cast<std::size_t>((lead + i) % 3)]; };
  finder.begin(picture.channels == 3 ? options.colour : LaserColour::mono,
               {channel(0), channel(1), channel(2)});
  finder.find(picture, runs, candidates, noise);
}

void LineExtractor::Work::measure(const PictureView& picture) {
  const std::span<const Choice> chosen = choice.chosen();
  line.samples.resize(chosen.size());
  LineSample* sample = line.samples.data();
  if (options.centre == CentreMethod::weighted_mean) {
    for (const Choice& c : chosen) fill_sample(c, c.first->centre, c.first->peak, *sample++);
    return;
  }
  gauss.begin(picture, options.axis, leading_channel(options.colour), line.noise);
  for (const Choice& c : chosen) {
    const Look& look = candidates.looks[static_cast<std::size_t>(c.first->look)];
    const bool calm = look.structure > kMoreThanNoise * line.noise;
    gauss.add(c.first->profile, c.first->centre, c.sigma, calm ? look.calm_mix : look.mix);
  }
  const GaussFit* fit = gauss.fits().data();
  for (const Choice& c : chosen) {
    const float peak =
        fit->settled && !c.first->clipped ? std::clamp(fit->amplitude, 0.0F, 255.0F) : c.first->peak;
    fill_sample(c, fit->centre, peak, *sample++);
    ++fit;
  }
}

void LineExtractor::Work::fill_sample(const Choice& c, float centre, float peak, LineSample& s) {
  const auto slot = static_cast<float>(c.first->profile);
  const bool column = options.axis == ProfileAxis::column;
  s.u = column ? slot : centre;
  s.v = column ? centre : slot;
  s.width = c.first->sigma;
  s.peak = peak;
  s.snr = peak / line.noise;
  s.saturated = c.first->saturated;
  if (c.second != nullptr) {
    s.second = c.second->centre;
    s.second_ratio = c.second->support / c.first->support;
    ++line.with_second;
  }
}

void LineExtractor::Work::finish() {
  if (line.samples.empty()) return;
  const auto n = static_cast<float>(line.samples.size());
  const auto saturated = [](const LineSample& s) { return s.saturated > 0; };
  const auto snr = [](const LineSample& s) { return s.snr; };
  // In any order: added one after the other, each would wait for the one before.
  line.mean_snr =
      std::transform_reduce(line.samples.begin(), line.samples.end(), 0.0F, std::plus<>(), snr) / n;
  line.saturated_fraction =
      static_cast<float>(std::count_if(line.samples.begin(), line.samples.end(), saturated)) / n;
}

LineExtractor::LineExtractor(const LineExtractorOptions& options) : work_(std::make_unique<Work>(options)) {}
LineExtractor::~LineExtractor() = default;
LineExtractor::LineExtractor(LineExtractor&&) noexcept = default;
LineExtractor& LineExtractor::operator=(LineExtractor&&) noexcept = default;

const LineExtractorOptions& LineExtractor::options() const {
  return work_->options;
}

const ExtractedLine& LineExtractor::extract(const cv::Mat& picture) {
  Work& w = *work_;
  w.start(picture);
  if (!usable(picture)) {
    w.line.no_point[static_cast<std::size_t>(NoPoint::bad_picture)] =
        static_cast<std::uint32_t>(std::max(1, w.line.profiles()));
    return w.line;
  }
  const PictureView view = view_of(picture);
  w.find_candidates(view);
  w.line.noise = w.noise.sigma();
  reject_dim(w.candidates, w.line.noise, w.options);
  w.continuity.link(w.candidates, w.line.profiles(), w.options);
  w.choice.choose(w.candidates, w.options, w.line);
  w.measure(view);
  w.finish();
  return w.line;
}

}  // namespace linescope
