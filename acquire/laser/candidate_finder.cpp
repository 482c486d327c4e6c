#include "acquire/laser/candidate_finder.hpp"

#include <algorithm>
#include <cstdlib>
#include <optional>

#include "acquire/laser/mean_candidate.hpp"

namespace linescope {
namespace {

constexpr int kNoiseEvery = 8;   // profiles, of the weighted mean: it reads no surroundings otherwise
constexpr int kNoisePixels = 5;  // at each end of a window, as far from the line as it reaches
constexpr int kFollowers = 7;    // profiles in a row that rely on a neighbour
constexpr int kSame = 2;         // px by which the ends of a run may differ from those of a neighbour
constexpr int kSpeck = 3;        // px; what is not longer is no rival of a line
constexpr int kLongest = 24;     // px; a longer run is more than a plain line

/// A saturated core has no colour: the marks beside it belong together when what lies between is at least as
/// bright.
std::size_t merge_across_cores(const Profile& profile, std::span<Run> runs, int widest) {
  std::size_t kept = 0;
  for (std::size_t i = 1; i < runs.size(); ++i) {
    Run& before = runs[kept];
    const int from = before.last + 1, to = runs[i].first;
    bool bridge = to - from <= widest;
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

}  // namespace

void CandidateFinder::begin(LaserColour colour, const ChannelMeans& scene) {
  excess_ = ColourExcess(colour);
  window_.start(colour, scene, options_.saturation_level);
  neighbours_ = {};
}

void CandidateFinder::find(const PictureView& picture, const RunFinder& runs, CandidateList& out,
                           NoiseMeter& noise) {
  const Source source{picture, runs, out, noise, leading_channel(options_.colour)};
  const int profiles = profile_count(picture, options_.axis);
  const bool mean = options_.centre == CentreMethod::weighted_mean;
  length_ = profile_of(picture, options_.axis, source.lead, 0).length;
  out.begin(profiles);
  block_.begin(picture, options_.axis, source.lead);
  for (index_ = 0; index_ < profiles;) {
    if (at_once_ && (mean ? find_means_at_once(source) : follow_at_once(source))) continue;
    find_one(source);
    ++index_;
  }
  begin_profile(out);
}

void CandidateFinder::find_one(const Source& source) {
  begin_profile(source.out);
  next().profile = -1;
  RunFinder::Runs found = source.runs.runs(index_);
  if (found.count == 0) return;
  const Profile profile = profile_of(source.picture, options_.axis, source.lead, index_);
  if (found.count > 1)
    found.count = merge_across_cores(profile, {found.run.data(), found.count}, options_.max_saturated);
  const std::span<const Run> runs(found.run.data(), found.count);
  options_.centre == CentreMethod::weighted_mean ? find_means(source, profile, runs)
                                                 : find_shapes(source, profile, runs);
}

bool CandidateFinder::find_means_at_once(const Source& source) {
  block_.collect(source.runs, index_, kBlockLanes);
  if (block_.length[0] == 0) return false;
  run_means(block_, excess_, levels_, means_);
  for (std::size_t lane = 0; lane < kBlockLanes && block_.length[lane] > 0; ++lane, ++index_) {
    const Run run = block_.run[lane];
    begin_profile(source.out);
    fill_mean_candidate(means_.of(lane), length_, index_, run, limits_, source.out.all.emplace_back());
    if (index_ % kNoiseEvery == 0)
      source.noise.add(profile_of(source.picture, options_.axis, source.lead, index_), run.last + 3,
                       run.last + 10);
  }
  return true;
}

void CandidateFinder::find_means(const Source& source, const Profile& profile, std::span<const Run> runs) {
  for (const Run run : runs) {
    fill_mean_candidate(run_mean(profile, run, excess_, levels_), length_, index_, run, limits_,
                        source.out.all.emplace_back());
    if (index_ % kNoiseEvery == 0) source.noise.add(profile, run.last + 3, run.last + 10);
  }
}

void CandidateFinder::find_shapes(const Source& source, const Profile& profile, std::span<const Run> runs) {
  const auto broad = [](const Run& run) { return run.length() > kSpeck; };
  const auto rivals = std::count_if(runs.begin(), runs.end(), broad);
  for (const Run run : runs) {
    const bool alone = runs.size() == 1 || (rivals == 1 && broad(run));
    if (alone && follow(profile, run, source.out)) continue;
    window_.read(profile, run);
    close_look(run, source.out);
    const int begin = window_.begin(), end = begin + window_.size();
    source.noise.add(profile, begin, begin + kNoisePixels - 1);
    source.noise.add(profile, end - kNoisePixels, end - 1);
  }
}

bool CandidateFinder::continues(Run before, Run run) const {
  return std::abs(run.first - before.first) <= kSame && std::abs(run.last - before.last) <= kSame &&
         run.length() <= kLongest && std::min<int>(run.first, length_ - 1 - run.last) >= run.length();
}

bool CandidateFinder::like_the_line(const LightSums& light) const {
  if (light.top >= options_.saturation_level || light.sum == 0) return false;
  return light.excess >= options_.colour_threshold || excess_.colourless();
}

void CandidateFinder::add_follower(const Neighbour& n, Run run, const LightSums& light,
                                   CandidateList& out) const {
  // A copy of the one that was looked at, not of the latest: what was just written field by field cannot be
  // read back as a whole without waiting.
  Candidate& c = out.all.emplace_back(out.all[static_cast<std::size_t>(n.candidate)]);
  c.profile = index_;
  c.centre = static_cast<float>(run.first) + static_cast<float>(light.moment) / static_cast<float>(light.sum);
  c.peak = static_cast<float>(light.top - n.background);
}

bool CandidateFinder::follow(const Profile& profile, Run run, CandidateList& out) {
  const Neighbour& n = neighbour();
  if (!n.before(index_) || n.followers >= kFollowers || !continues(n.run, run)) return false;
  const LightSums light = light_sums(profile, run, excess_, n.background);
  if (!like_the_line(light)) return false;
  add_follower(n, run, light, out);
  next() = {index_, run, n.candidate, n.background, n.followers + 1};
  return true;
}

bool CandidateFinder::follow_at_once(const Source& source) {
  const Neighbour& n = neighbour();
  const int from = index_, most = kFollowers - n.followers;
  if (!n.before(from) || most <= 0 || !continues(n.run, source.runs.only_run(from))) return false;
  block_.collect(source.runs, from, most);
  light_sums(block_, excess_, n.background, lights_);
  Run before = n.run;
  for (std::size_t lane = 0; lane < kBlockLanes && block_.length[lane] > 0; ++lane, ++index_) {
    const Run run = block_.run[lane];
    const LightSums light = lights_.of(lane);
    if (!continues(before, run) || !like_the_line(light)) break;
    begin_profile(source.out);
    add_follower(n, run, light, source.out);
    before = run;
  }
  const int followers = index_ - from;
  if (followers == 0) return false;
  neighbours_[static_cast<std::size_t>(~index_ & 1)] = {index_ - 1, before, n.candidate, n.background,
                                                        n.followers + followers};
  return true;
}

void CandidateFinder::close_look(Run run, CandidateList& out) {
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
  const int first = static_cast<int>(out.all.size()), look = static_cast<int>(out.looks.size());
  out.looks.push_back({window_.mix(), window_.calm_mix(), window_.structure()});
  if (before) out.all.push_back(candidate_from(*before, look));
  out.all.push_back(candidate_from(main, look));
  if (after) out.all.push_back(candidate_from(*after, look));
  const Candidate& c = out.all.back();
  const bool plain = !before && !after && c.good && !c.clipped && window_.mix() == LightMix{};
  if (plain && next().profile < 0) next() = {index_, run, first, window_.background(), 0};
}

Candidate CandidateFinder::candidate_from(const Hump& h, int look) const {
  Candidate c;
  c.profile = index_;
  c.centre = static_cast<float>(window_.begin()) + h.centre;
  c.sigma = h.width / kFullWidthPerSigma;
  c.look = look;
  c.clipped = window_.clipped();
  int peak = 0, saturated = 0;
  for (int i = h.first; i <= h.last; ++i) {
    peak = std::max(peak, window_.lead(i));
    saturated += window_.lead(i) >= options_.saturation_level ? 1 : 0;
  }
  const int floor = std::min(window_.lead(0), window_.lead(window_.size() - 1));
  c.peak = static_cast<float>(c.clipped ? peak - floor : h.height);
  c.saturated = static_cast<float>(saturated);
  const bool certain = excess_.colourless() || has_colour(h);
  if (h.height <= 0 || !(certain || rises_in_colour(h)))
    c.reject(NoPoint::wrong_colour);
  else if (!certain && h.width > 0.5F * static_cast<float>(options_.ridge_reach))
    c.reject(NoPoint::too_wide);  // what is coloured only by comparison must at least be as narrow as a ridge
  else
    c.judge_shape(h.width, window_.begin() + h.first, length_ - 1 - window_.begin() - h.last, limits_);
  return c;
}

/// Some of it, or of the skirts of a clipped one, shows the laser's colour beyond doubt.
bool CandidateFinder::has_colour(const Hump& h) const {
  if (excess(h.peak) >= options_.colour_threshold) return true;
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
  const ChannelMeans flanks = window_.flanks();
  for (int c = 0; c < 3; ++c) {
    const auto k = static_cast<std::size_t>(c);
    for (int i = h.first; i <= h.last; ++i) added[k] += static_cast<float>(window_.value(c, i)) - flanks[k];
  }
  const auto ratio = [this](const ChannelMeans& light) {
    float lit = 1e9F, dark = 1;
    for (std::size_t c = 0; c < 3; ++c) {
      if (excess_.lit(c))
        lit = std::min(lit, light[c]);
      else
        dark = std::max(dark, light[c]);
    }
    return lit / dark;
  };
  constexpr float kNeutral = 1.05F;
  const float light = ratio(added);
  return light > kNeutral && light > static_cast<float>(options_.colour_ratio) * ratio(window_.ambient());
}

}  // namespace linescope
