#include "acquire/laser/candidate_finder.hpp"

#include <algorithm>
#include <array>
#include <optional>

namespace linescope {
namespace {

constexpr float kSigmaPerFullWidth = 1.0F / 2.3548F;
constexpr int kNoiseEvery = 8;  // profiles, of the weighted mean: it reads no surroundings otherwise

/// min over the laser's channels minus max over the others, channels in the order of Profile.
template <class Number>
std::array<Number, 2> lit_and_dark(const std::array<Number, 3>& light, LaserColour colour, Number most,
                                   Number least) {
  const unsigned on = static_cast<unsigned>(colour);
  const int lead = leading_channel(colour);
  std::array<Number, 2> out{most, least};
  for (int c = 0; c < 3; ++c) {
    const Number v = light[static_cast<std::size_t>(c)];
    const bool lit = (on >> ((lead + c) % 3) & 1U) != 0;
    if (lit)
      out[0] = std::min(out[0], v);
    else
      out[1] = std::max(out[1], v);
  }
  return out;
}

int excess_of(const std::array<int, 3>& light, LaserColour colour) {
  const auto [lit, dark] = lit_and_dark<int>(light, colour, 255, 0);
  return lit - dark;
}

}  // namespace

void CandidateFinder::find(const Profile& profile, int index, std::span<Run> runs,
                           std::vector<Candidate>& out, NoiseMeter& noise) {
  length_ = profile.length;
  index_ = index;
  const std::size_t n = runs.size() > 1 ? merge_across_cores(profile, runs) : runs.size();
  for (const Run run : runs.first(n)) {
    if (options_.centre == CentreMethod::weighted_mean) {
      out.push_back(by_mean(profile, run));
      if (index % kNoiseEvery == 0) noise.add(profile, run.last + 3, run.last + 10);
      continue;
    }
    window_.read(profile, run, colour_, scene_, options_.saturation_level);
    by_shape(run, out);
    noise.add(profile, window_.begin(), window_.begin() + window_.flank() + 3);
  }
}

/// A saturated core has no colour: the marks beside it belong together when what lies between is at least as
/// bright.
std::size_t CandidateFinder::merge_across_cores(const Profile& profile, std::span<Run> runs) const {
  std::size_t kept = 0;
  for (std::size_t i = 1; i < runs.size(); ++i) {
    Run& before = runs[kept];
    const int from = before.last + 1, to = runs[i].first;
    bool bridge = to - from <= options_.max_saturated;
    if (bridge) {
      int sum = 0;
      for (int k = from; k < to; ++k) sum += profile.light(k);
      bridge = sum >= std::max(profile.light(before.last), profile.light(to)) * (to - from);
    }
    if (bridge)
      before.last = runs[i].last;
    else
      runs[++kept] = runs[i];
  }
  return kept + 1;
}

Candidate CandidateFinder::by_mean(const Profile& profile, Run run) const {
  int sum = 0, peak = 1, saturated = 0;
  long moment = 0;
  for (int i = run.first; i <= run.last; ++i) {
    const int w = excess_of({profile.value(0, i), profile.value(1, i), profile.value(2, i)}, colour_);
    saturated += profile.light(i) >= options_.saturation_level;
    if (w < options_.colour_threshold) continue;
    sum += w;
    moment += static_cast<long>(w) * (i - run.first);
    peak = std::max(peak, w);
  }
  Candidate c;
  c.profile = index_;
  c.centre =
      static_cast<float>(run.first) + static_cast<float>(moment) / static_cast<float>(std::max(sum, 1));
  c.sigma = static_cast<float>(sum) / (static_cast<float>(peak) * 2.5066F);
  c.peak = static_cast<float>(peak);
  c.saturated = static_cast<float>(saturated);
  const float width = c.sigma / kSigmaPerFullWidth;
  if (run.first < options_.border || run.last >= length_ - options_.border)
    c.reject(NoPoint::at_border);
  else if (saturated > options_.max_saturated)
    c.reject(NoPoint::saturated);
  else if (width > static_cast<float>(options_.max_width))
    c.reject(NoPoint::too_wide);
  else if (width < static_cast<float>(options_.min_width))
    c.reject(NoPoint::too_narrow);
  return c;
}

void CandidateFinder::by_shape(Run run, std::vector<Candidate>& out) {
  const int from = run.first - window_.begin(), to = run.last - window_.begin() + 1;
  const int box = std::clamp(run.length() / 6, 3, 15);
  const Hump main = hump_around(window_, brightest(window_, from, to, box), options_.merge_gap);

  // What is left of the run on either side may hold a second line.
  const auto rest = [&](int a, int b) -> std::optional<Hump> {
    if (b - a < 3) return std::nullopt;
    const Hump h = hump_around(window_, brightest(window_, a, b, std::min(box, 5)), options_.merge_gap);
    const bool apart = h.last < main.first || h.first > main.last;
    return apart && 2 * h.height >= main.height ? std::optional(h) : std::nullopt;
  };
  const std::optional<Hump> before = rest(from, main.first - options_.merge_gap);
  const std::optional<Hump> after = rest(main.last + 1 + options_.merge_gap, to);
  if (before) out.push_back(candidate_from(*before));
  out.push_back(candidate_from(main));
  if (after) out.push_back(candidate_from(*after));
}

Candidate CandidateFinder::candidate_from(const Hump& h) const {
  Candidate c;
  c.profile = index_;
  c.centre = static_cast<float>(window_.begin()) + h.centre;
  c.sigma = h.width * kSigmaPerFullWidth;
  c.mix = window_.mix();
  c.calm_mix = window_.calm_mix();
  c.structure = window_.structure();
  c.clipped = window_.clipped();
  int peak = 0, saturated = 0;
  for (int i = h.first; i <= h.last; ++i) {
    peak = std::max(peak, window_.channel(0, i));
    saturated += window_.channel(0, i) >= options_.saturation_level;
  }
  c.peak = static_cast<float>(
      c.clipped ? peak - std::min(window_.channel(0, 0), window_.channel(0, window_.size() - 1)) : h.height);
  c.saturated = static_cast<float>(saturated);
  const bool certain = colour_ == LaserColour::mono || has_colour(h);
  // A ridge that is coloured only by comparison must at least be narrow, as a ridge is.
  const double most_width =
      certain ? options_.max_width : std::min(options_.max_width, 0.5 * options_.ridge_reach);
  if (h.height <= 0 || !(certain || rises_in_colour(h)))
    c.reject(NoPoint::wrong_colour);
  else if (window_.begin() + h.first < options_.border ||
           window_.begin() + h.last >= length_ - options_.border)
    c.reject(NoPoint::at_border);
  else if (saturated > options_.max_saturated)
    c.reject(NoPoint::saturated);
  else if (h.width > static_cast<float>(most_width))
    c.reject(NoPoint::too_wide);
  else if (h.width < static_cast<float>(options_.min_width))
    c.reject(NoPoint::too_narrow);
  return c;
}

int CandidateFinder::excess(int i) const {
  return excess_of({window_.channel(0, i), window_.channel(1, i), window_.channel(2, i)}, colour_);
}

/// Some of it, or of the skirts of a clipped one, shows the laser's colour beyond doubt.
bool CandidateFinder::has_colour(const Hump& h) const {
  const int skirt = window_.clipped() ? (h.last - h.first + 1) / 2 + 2 : 0;
  const int from = std::max(0, h.first - skirt), to = std::min(window_.size() - 1, h.last + skirt);
  for (int i = from; i <= to; ++i)
    if (excess(i) >= options_.colour_threshold) return true;
  return false;
}

/// The light of a lamp, mirrored, and printed texture add the colour of the surroundings; the laser adds its
/// own.
bool CandidateFinder::rises_in_colour(const Hump& h) const {
  ChannelMeans added{};
  for (int c = 0; c < 3; ++c) {
    const auto k = static_cast<std::size_t>(c);
    for (int i = h.first; i <= h.last; ++i)
      added[k] += static_cast<float>(window_.channel(c, i)) - window_.flanks()[k];
  }
  const auto ratio = [this](const ChannelMeans& light) {
    const auto [lit, dark] = lit_and_dark<float>(light, colour_, 1e9F, 1.0F);
    return lit / dark;
  };
  constexpr float kNeutral = 1.05F;
  const float light = ratio(added);
  return light > kNeutral && light > static_cast<float>(options_.colour_ratio) * ratio(window_.ambient());
}

}  // namespace linescope
