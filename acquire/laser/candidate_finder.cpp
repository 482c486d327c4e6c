#include "acquire/laser/candidate_finder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace linescope {
namespace {

constexpr float kSigmaPerFullWidth = 1.0F / 2.3548F;
constexpr int kFlank = 4;  // px at each end of the window that count as background

int excess_at(const Profile& p, LaserColour colour, int i) {
  const unsigned on = static_cast<unsigned>(colour);
  const int lead = leading_channel(colour);
  int shines = 255, dark = 0;
  for (int c = 0; c < 3; ++c) {
    const bool lit = (on >> ((lead + c) % 3) & 1U) != 0;
    if (lit)
      shines = std::min(shines, p.value(c, i));
    else
      dark = std::max(dark, p.value(c, i));
  }
  return shines - dark;
}

}  // namespace

/// A bump above half of its height, in indices of the window.
struct CandidateFinder::Hump {
  int first = 0, last = 0;  ///< pixels above half height, small dips included
  int base = 0, level = 0;  ///< background and half height
  int peak = 0;             ///< index of the highest place
  float centre = 0, width = 0;
};

void CandidateFinder::find(const Profile& profile, int index, std::span<Run> runs, bool use_colour,
                           std::vector<Candidate>& out, NoiseMeter& noise) {
  const std::size_t n = runs.size() > 1 ? merge_across_cores(profile, runs) : runs.size();
  for (const Run run : runs.first(n)) {
    if (options_.centre == CentreMethod::weighted_mean) {
      by_mean(profile, index, run, out);
      if (index % 8 == 0) noise.add(profile, run.last + 3, run.last + 10);
    } else {
      by_shape(profile, index, run, use_colour, out, noise);
    }
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

void CandidateFinder::by_mean(const Profile& profile, int index, Run run, std::vector<Candidate>& out) {
  int sum = 0, peak = 0, saturated = 0;
  long moment = 0;
  for (int i = run.first; i <= run.last; ++i) {
    const int w = excess_at(profile, options_.colour, i);
    saturated += profile.light(i) >= options_.saturation_level;
    if (w < options_.colour_threshold) continue;
    sum += w;
    moment += static_cast<long>(w) * (i - run.first);
    peak = std::max(peak, w);
  }
  Candidate c;
  c.profile = index;
  c.centre = static_cast<float>(run.first + static_cast<double>(moment) / sum);
  c.sigma = static_cast<float>(sum / (peak * 2.5066));
  c.peak = static_cast<float>(peak);
  c.saturated = static_cast<float>(saturated);
  out.push_back(c);
}

void CandidateFinder::gather(const Profile& profile, Run run) {
  const int pad = std::clamp(run.length(), 8, 24);
  begin_ = std::max(0, run.first - pad);
  const int end = std::min(profile.length, run.last + pad + 1);
  light_.resize(static_cast<std::size_t>(end - begin_));
  all_channels_ = false;
  const std::uint8_t* p = profile.at[0] + begin_ * profile.step;
  for (int& l : light_) {
    l = *p;
    p += profile.step;
  }
}

void CandidateFinder::sum_channels(const Profile& profile) {
  all_channels_ = true;
  for (std::size_t i = 0; i < light_.size(); ++i) {
    const int at = begin_ + static_cast<int>(i);
    light_[i] += profile.value(1, at) + profile.value(2, at);
  }
}

/// Index of the middle of the brightest box within [from, to).
int CandidateFinder::highest(int from, int to, int box) const {
  box = std::min(box, to - from);
  int sum = 0;
  for (int i = from; i < from + box; ++i) sum += light_[static_cast<std::size_t>(i)];
  int best = sum, at = from;
  for (int i = from + box; i < to; ++i) {
    sum += light_[static_cast<std::size_t>(i)] - light_[static_cast<std::size_t>(i - box)];
    if (sum > best) best = sum, at = i - box + 1;
  }
  return at + box / 2;
}

CandidateFinder::Hump CandidateFinder::hump_at(int peak, int base) const {
  const int n = static_cast<int>(light_.size());
  const auto light = [this](int i) { return light_[static_cast<std::size_t>(i)]; };
  Hump h;
  h.peak = peak;
  h.base = base;
  const int top = (light(std::max(peak - 1, 0)) + 2 * light(peak) + light(std::min(peak + 1, n - 1))) / 4;
  h.level = (top + base + 1) / 2;
  const auto edge = [&](int step) {
    int last = peak;
    for (int i = peak, hole = 0; i >= 0 && i < n && hole <= options_.merge_gap; i += step) {
      const bool above = light(i) >= h.level;
      hole = above ? 0 : hole + 1;
      if (above) last = i;
    }
    return last;
  };
  h.first = edge(-1);
  h.last = edge(1);
  int sum = 0;
  long moment = 0;
  for (int i = h.first; i <= h.last; ++i) {
    const int w = std::max(0, light(i) - h.level);
    sum += w;
    moment += static_cast<long>(w) * (i - h.first);
  }
  h.centre =
      sum > 0 ? static_cast<float>(h.first + static_cast<double>(moment) / sum) : static_cast<float>(peak);
  const auto beyond = [&](int inside, int outside) {
    if (outside < 0 || outside >= n) return 0.5F;
    const int drop = light(inside) - light(outside);
    return drop > 0 ? static_cast<float>(light(inside) - h.level) / static_cast<float>(drop) : 0.5F;
  };
  h.width = static_cast<float>(h.last - h.first) + beyond(h.first, h.first - 1) + beyond(h.last, h.last + 1);
  return h;
}

/// Does the hump add light of the laser's colour to what lies beside it? Light of a lamp, mirrored, or
/// printed texture adds the colour of the surroundings.
bool CandidateFinder::laser_coloured(const Profile& profile, const Hump& h) const {
  const int n = static_cast<int>(light_.size());
  for (const int i : {h.first, h.peak, h.last})
    if (excess_at(profile, options_.colour, begin_ + i) >= options_.colour_threshold) return true;
  std::array<double, 3> added{}, around{};
  for (int c = 0; c < 3; ++c) {
    const auto k = static_cast<std::size_t>(c);
    const int flank = std::min(kFlank, n / 4);
    for (int i = 0; i < flank; ++i)
      around[k] += profile.value(c, begin_ + i) + profile.value(c, begin_ + n - 1 - i);
    for (int i = h.first; i <= h.last; ++i) added[k] += profile.value(c, begin_ + i);
    if (flank > 0) added[k] -= around[k] / (2 * flank) * (h.last - h.first + 1);
  }
  const unsigned on = static_cast<unsigned>(options_.colour);
  const int lead = leading_channel(options_.colour);
  const auto ratio = [&](const std::array<double, 3>& light) {
    double shines = 1e9, dark = 1;
    for (int c = 0; c < 3; ++c) {
      const double v = light[static_cast<std::size_t>(c)];
      if ((on >> ((lead + c) % 3) & 1U) != 0)
        shines = std::min(shines, v);
      else
        dark = std::max(dark, v);
    }
    return shines / dark;
  };
  const double light = ratio(added);
  return light > 1.05 && light > options_.colour_ratio * ratio(around);
}

Candidate CandidateFinder::candidate_from(const Profile& profile, int index, const Hump& h,
                                          bool use_colour) const {
  Candidate c;
  c.profile = index;
  c.centre = static_cast<float>(begin_) + h.centre;
  c.sigma = h.width * kSigmaPerFullWidth;
  c.all_channels = all_channels_;
  int peak = 0, saturated = 0;
  for (int i = h.first; i <= h.last; ++i) {
    const int light = profile.light(begin_ + i);
    peak = std::max(peak, light);
    saturated += light >= options_.saturation_level;
  }
  const int end = static_cast<int>(light_.size()) - 1;
  c.peak = static_cast<float>(peak - std::min(profile.light(begin_), profile.light(begin_ + end)));
  if (!all_channels_) c.peak = static_cast<float>(peak - h.base);
  c.saturated = static_cast<float>(saturated);
  if (use_colour && !laser_coloured(profile, h))
    c.reject(NoPoint::wrong_colour);
  else if (begin_ + h.first < options_.border || begin_ + h.last >= profile.length - options_.border)
    c.reject(NoPoint::at_border);
  else if (saturated > options_.max_saturated)
    c.reject(NoPoint::saturated);
  else if (h.width > options_.max_width)
    c.reject(NoPoint::too_wide);
  else if (h.width < options_.min_width)
    c.reject(NoPoint::too_narrow);
  return c;
}

void CandidateFinder::by_shape(const Profile& profile, int index, Run run, bool use_colour,
                               std::vector<Candidate>& out, NoiseMeter& noise) {
  gather(profile, run);
  int clipped = 0;
  for (const int l : light_) clipped += l >= options_.saturation_level;
  if (clipped >= 3 && use_colour) sum_channels(profile);

  const int n = static_cast<int>(light_.size());
  const int flank = std::min(kFlank, n / 4);
  int left = 0, right = 0;
  for (int i = 0; i < flank; ++i) {
    left += light_[static_cast<std::size_t>(i)];
    right += light_[static_cast<std::size_t>(n - 1 - i)];
  }
  const int base = flank > 0 ? std::max(left, right) / flank : 0;
  const int from = run.first - begin_, to = run.last - begin_ + 1;
  const int box = std::clamp(run.length() / 6, 3, 15);
  const Hump main = hump_at(highest(from, to, box), base);
  noise.add(profile, begin_, begin_ + flank + 3);

  // What is left of the run on either side may hold a second line.
  const auto rest = [&](int a, int b) -> std::optional<Hump> {
    if (b - a < 3) return std::nullopt;
    const Hump h = hump_at(highest(a, b, std::min(box, 5)), base);
    const bool apart = h.last < main.first || h.first > main.last;
    const bool strong = h.level > base && 2 * (h.level - base) >= (main.level - base);
    return apart && strong ? std::optional(h) : std::nullopt;
  };
  const std::optional<Hump> below = rest(from, main.first - options_.merge_gap);
  const std::optional<Hump> above = rest(main.last + 1 + options_.merge_gap, to);
  if (below) out.push_back(candidate_from(profile, index, *below, use_colour));
  out.push_back(candidate_from(profile, index, main, use_colour));
  if (above) out.push_back(candidate_from(profile, index, *above, use_colour));
}

}  // namespace linescope
