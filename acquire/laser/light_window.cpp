#include "acquire/laser/light_window.hpp"

#include <algorithm>

namespace linescope {
namespace {

constexpr int kFlank = 4;        // px
constexpr int kClipped = 3;      // saturated px from which the top of the line is flat
constexpr float kDark = 8;       // grey levels of ambient light below which there is nothing to take out
constexpr float kMostScale = 3;  // ambient light more lopsided than this is not ambient

}  // namespace

void LightWindow::read(const Profile& profile, Run run, LaserColour colour, const ChannelMeans& scene,
                       int saturation_level) {
  gather(profile, run);
  choose_mix(run, colour, scene, saturation_level);
  blend();
}

void LightWindow::gather(const Profile& profile, Run run) {
  const int pad = std::clamp(run.length(), 8, 24);
  begin_ = std::max(0, run.first - pad);
  const auto n = static_cast<std::size_t>(std::min(profile.length, run.last + pad + 1) - begin_);
  light_.resize(n);
  for (std::size_t c = 0; c < 3; ++c) {
    channels_[c].resize(n);
    const std::uint8_t* p = profile.at[c] + begin_ * profile.step;
    for (int& value : channels_[c]) {
      value = *p;
      p += profile.step;
    }
  }
  flank_ = std::min(kFlank, size() / 4);
  for (int c = 0; c < 3; ++c) {
    int sum = 0;
    for (int i = 0; i < flank_; ++i) sum += channel(c, i) + channel(c, size() - 1 - i);
    flanks_[static_cast<std::size_t>(c)] =
        static_cast<float>(sum) / static_cast<float>(std::max(1, 2 * flank_));
  }
}

ChannelMeans LightWindow::means(Run run) const {
  ChannelMeans mean{};
  for (int c = 0; c < 3; ++c) {
    int sum = 0;
    for (int i = run.first - begin_; i <= run.last - begin_; ++i) sum += channel(c, i);
    mean[static_cast<std::size_t>(c)] = static_cast<float>(sum) / static_cast<float>(run.length());
  }
  return mean;
}

/// Of the channels in which the laser does not shine the one that rises least at the run; 0 when there is
/// none.
int LightWindow::calmest_channel(const ChannelMeans& inside, LaserColour colour) const {
  const unsigned on = static_cast<unsigned>(colour);
  const int lead = leading_channel(colour);
  std::size_t best = 0;
  float least = 0;
  for (std::size_t c = 1; c < 3; ++c) {
    if ((on >> ((static_cast<std::size_t>(lead) + c) % 3) & 1U) != 0) continue;
    const float rise = inside[c] / (ambient_[c] + 1);
    if (best == 0 || rise < least) best = c, least = rise;
  }
  return static_cast<int>(best);
}

/// Largest minus smallest of the means of three neighbours: structure, hardly noise.
float LightWindow::range(int c) const {
  int least = 3 * 255, most = 0;
  for (int i = 1; i + 1 < size(); ++i) {
    const int sum = channel(c, i - 1) + channel(c, i) + channel(c, i + 1);
    least = std::min(least, sum);
    most = std::max(most, sum);
  }
  return static_cast<float>(std::max(0, most - least)) / 3;
}

void LightWindow::choose_mix(Run run, LaserColour colour, const ChannelMeans& scene, int saturation_level) {
  mix_ = calm_mix_ = {};
  structure_ = 0;
  const auto& lead = channels_[0];
  const auto saturated =
      std::count_if(lead.begin(), lead.end(), [&](int l) { return l >= saturation_level; });
  clipped_ = saturated >= kClipped;
  ambient_ = flanks_;
  if (colour == LaserColour::mono) return;
  const ChannelMeans inside = means(run);
  const bool patch = 2 * (flanks_[1] + flanks_[2]) < inside[1] + inside[2];
  if (patch) ambient_ = scene;
  if (clipped_) {
    mix_ = {1, 1};
    return;
  }
  // Near saturation the other channels rise with the laser: subtracting them would carve out the line's core.
  if (saturated > 0) return;
  const auto calm = static_cast<std::size_t>(calmest_channel(inside, colour));
  if (calm == 0 || ambient_[calm] < kDark) return;
  calm_mix_[calm - 1] = -std::min(kMostScale, ambient_[0] / ambient_[calm]);
  structure_ = range(static_cast<int>(calm));
  if (structure_ > range(0) / 5 + 8) mix_ = calm_mix_;
}

void LightWindow::blend() {
  const bool plain = mix_[0] == 0 && mix_[1] == 0;
  for (std::size_t i = 0; i < light_.size(); ++i) {
    light_[i] = channels_[0][i];
    if (plain) continue;
    const float others =
        mix_[0] * static_cast<float>(channels_[1][i]) + mix_[1] * static_cast<float>(channels_[2][i]);
    light_[i] += static_cast<int>(others);
  }
  int left = 0, right = 0;
  for (int i = 0; i < flank_; ++i) {
    left += light(i);
    right += light(size() - 1 - i);
  }
  background_ = flank_ > 0 ? std::max(left, right) / flank_ : 0;
}

}  // namespace linescope
