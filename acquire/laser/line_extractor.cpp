#include "acquire/laser/line_extractor.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

#include "acquire/laser/candidate_finder.hpp"
#include "acquire/laser/continuity.hpp"
#include "acquire/laser/gauss_centre.hpp"
#include "acquire/laser/run_finder.hpp"

namespace linescope {
namespace {

constexpr int kSmooth = 8;  // profiles to either side over which the line's width is averaged

bool usable(const cv::Mat& m) {
  const bool type = m.type() == CV_8UC3 || m.type() == CV_8UC1;
  return m.dims == 2 && type && m.cols >= 16 && m.rows >= 16 && m.cols <= 16384 && m.rows <= 16384;
}

PictureView view_of(const cv::Mat& m) {
  return {m.data, static_cast<std::ptrdiff_t>(m.step[0]), m.cols, m.rows, m.channels()};
}

std::uint32_t& at(NoPointCounts& counts, NoPoint reason) {
  return counts[static_cast<std::size_t>(reason)];
}

/// The three-pixel means of some tens of pixels of pure noise span 2.4 times their standard deviation,
/// rarely 4.
constexpr float kMoreThanNoise = 4.5F;

const LightMix& mix_for(const Candidate& c, float noise) {
  return c.structure > kMoreThanNoise * noise ? c.calm_mix : c.mix;
}

}  // namespace

struct LineExtractor::Work {
  explicit Work(const LineExtractorOptions& o) : options(o), finder(o) {}

  void start(const cv::Mat& m);
  void find_candidates(const PictureView& picture);
  void reject_dim();
  void choose_in(int profile);
  void smooth_widths();
  void refine(const PictureView& picture);
  void finish();

  LineExtractorOptions options;
  RunFinder runs;
  CandidateFinder finder;
  CandidateList candidates;
  NoiseMeter noise;
  Continuity continuity;
  GaussCentre gauss;
  struct Choice {
    const Candidate* first;
    const Candidate* second;
    float sigma;  ///< averaged along the line
  };
  std::vector<Choice> chosen;
  std::vector<double> running;  ///< sums of the widths of `chosen`
  std::vector<float> peaks;
  ExtractedLine line;
};

void LineExtractor::Work::start(const cv::Mat& m) {
  line.width = m.cols;
  line.height = m.rows;
  line.axis = options.axis;
  line.samples.clear();
  line.no_point = {};
  line.rejected_candidates = {};
  line.crowded = line.with_second = 0;
  line.noise = line.mean_snr = line.saturated_fraction = 0;
  noise.clear();
  chosen.clear();
}

void LineExtractor::Work::find_candidates(const PictureView& picture) {
  const MaskRule rule = mask_rule(options, picture.channels);
  runs.find(picture, rule, options.merge_gap, fastest_row_marker(picture, rule));
  line.crowded = runs.dropped();
  const int profiles = line.profiles();
  const LaserColour colour = picture.channels == 3 ? options.colour : LaserColour::mono;
  const int lead = leading_channel(options.colour);
  const std::array<float, 3>& scene = runs.ambient();
  const auto channel = [&](int i) { return scene[static_cast<std::size_t>((lead + i) % 3)]; };
  finder.begin(colour, {channel(0), channel(1), channel(2)});
  candidates.begin(profiles);
  for (int p = 0; p < profiles; ++p) {
    candidates.first.push_back(static_cast<int>(candidates.all.size()));
    const std::span<Run> found = runs.runs(p);
    if (!found.empty())
      finder.find(profile_of(picture, options.axis, lead, p), p, found, candidates.all, noise);
  }
  candidates.first.push_back(static_cast<int>(candidates.all.size()));
}

void LineExtractor::Work::reject_dim() {
  line.noise = noise.sigma();
  float least = static_cast<float>(options.min_snr) * line.noise;
  if (options.relative_threshold > 0) {
    peaks.clear();
    for (const Candidate& c : candidates.all)
      if (c.good) peaks.push_back(c.peak);
    if (!peaks.empty()) {
      const auto strong =
          peaks.begin() + static_cast<std::ptrdiff_t>(static_cast<double>(peaks.size() - 1) * 0.95);
      std::nth_element(peaks.begin(), strong, peaks.end());
      least = std::max(least, static_cast<float>(options.relative_threshold) * *strong);
    }
  }
  for (Candidate& c : candidates.all)
    if (c.good && c.peak < least) c.reject(NoPoint::too_dim);
}

void LineExtractor::Work::choose_in(int profile) {
  const Candidate* best = nullptr;
  const Candidate* second = nullptr;
  const Candidate* brightest = nullptr;  // of the rejected
  for (Candidate* c = candidates.begin_of(profile); c != candidates.end_of(profile); ++c) {
    if (!c->good) {
      ++at(line.rejected_candidates, c->fault);
      if (brightest == nullptr || c->peak > brightest->peak) brightest = c;
    } else if (best == nullptr || c->support > best->support) {
      second = best;
      best = c;
    } else if (second == nullptr || c->support > second->support) {
      second = c;
    }
  }
  if (best == nullptr) {
    ++at(line.no_point, brightest == nullptr ? NoPoint::no_light : brightest->fault);
  } else if (second != nullptr && second->support > static_cast<float>(options.ambiguity) * best->support) {
    ++at(line.no_point, NoPoint::ambiguous);
    at(line.rejected_candidates, NoPoint::ambiguous) += 2;
  } else {
    chosen.push_back({best, second, best->sigma});
  }
}

/// A line changes its width slowly, a single profile knows it badly.
void LineExtractor::Work::smooth_widths() {
  const std::size_t n = chosen.size();
  running.assign(n + 1, 0);
  for (std::size_t i = 0; i < n; ++i)
    running[i + 1] = running[i] + static_cast<double>(chosen[i].first->sigma);
  for (std::size_t i = 0; i < n; ++i) {
    std::size_t a = i, b = i;
    while (a > 0 && i - a < kSmooth && chosen[a - 1].first->piece == chosen[i].first->piece) --a;
    while (b + 1 < n && b - i < kSmooth && chosen[b + 1].first->piece == chosen[i].first->piece) ++b;
    chosen[i].sigma = static_cast<float>((running[b + 1] - running[a]) / static_cast<double>(b + 1 - a));
  }
}

void LineExtractor::Work::refine(const PictureView& picture) {
  const bool column = options.axis == ProfileAxis::column;
  const bool gauss_wanted = options.centre == CentreMethod::gauss_weighted;
  const int lead = leading_channel(options.colour);
  if (gauss_wanted) smooth_widths();
  for (const Choice& c : chosen) {
    float centre = c.first->centre, peak = c.first->peak;
    if (gauss_wanted) {
      const Profile profile = profile_of(picture, options.axis, lead, c.first->profile);
      const GaussFit fit = gauss.fit(profile, centre, c.sigma, line.noise, mix_for(*c.first, line.noise));
      if (fit.settled) {
        centre = fit.centre;
        if (!c.first->clipped) peak = std::clamp(fit.amplitude, 0.0F, 255.0F);
      }
    }
    const auto slot = static_cast<float>(c.first->profile);
    LineSample s;
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
    line.samples.push_back(s);
  }
}

void LineExtractor::Work::finish() {
  if (line.samples.empty()) return;
  double snr = 0;
  int saturated = 0;
  for (const LineSample& s : line.samples) {
    snr += static_cast<double>(s.snr);
    saturated += s.saturated > 0;
  }
  const auto n = static_cast<double>(line.samples.size());
  line.mean_snr = static_cast<float>(snr / n);
  line.saturated_fraction = static_cast<float>(saturated / n);
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
    at(w.line.no_point, NoPoint::bad_picture) = static_cast<std::uint32_t>(std::max(1, w.line.profiles()));
    return w.line;
  }
  const PictureView view = view_of(picture);
  w.find_candidates(view);
  w.reject_dim();
  w.continuity.link(w.candidates, w.line.profiles(), w.options);
  for (int p = 0; p < w.line.profiles(); ++p) w.choose_in(p);
  w.refine(view);
  w.finish();
  return w.line;
}

}  // namespace linescope
