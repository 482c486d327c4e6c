#include "acquire/laser/light_window.hpp"

#include <algorithm>

namespace linescope {
namespace {

constexpr int kFlank = 4;        // px
constexpr int kClipped = 3;      // saturated px from which the top of the line is flat
constexpr float kDark = 8;       // grey levels of ambient light below which there is nothing to take out
constexpr float kMostScale = 3;  // ambient light more lopsided than this is not ambient
constexpr int kVector = 16;      // elements that loops take at once

int rounded_up(int n) {
  return (n + kVector - 1) / kVector * kVector;
}

/// Largest minus smallest of the means of three neighbours: structure, hardly noise. Two elements behind n
/// are read.
float range_of(const std::uint8_t* v, int n) {
  std::int16_t least = 3 * 255, most = 0;
  for (int i = 0; i < n; ++i) {
    const auto sum = static_cast<std::int16_t>(v[i] + v[i + 1] + v[i + 2]);
    least = std::min(least, sum);
    most = std::max(most, sum);
  }
  return static_cast<float>(most - least) / 3;
}

int count_from(const std::uint8_t* v, int n, int level) {
  std::uint8_t most = 0;
  for (int i = 0; i < n; ++i) most = std::max(most, v[i]);
  if (most < level) return 0;  // the rule, and quicker to see than to count
  int count = 0;
  for (int i = 0; i < n; ++i) count += v[i] >= level ? 1 : 0;
  return count;
}

}  // namespace

void LightWindow::start(LaserColour colour, const ChannelMeans& scene, int saturation_level) {
  const int lead = leading_channel(colour);
  for (int c = 0; c < 3; ++c)
    lit_[static_cast<std::size_t>(c)] = (static_cast<unsigned>(colour) >> ((lead + c) % 3) & 1U) != 0;
  scene_ = scene;
  saturation_level_ = saturation_level;
}

void LightWindow::read(const Profile& profile, Run run) {
  const int pad = std::clamp(run.length(), 8, 24);
  profile_ = profile;
  begin_ = std::max(0, run.first - pad);
  size_ = std::min(profile.length, run.last + pad + 1) - begin_;
  flank_ = std::min(kFlank, size_ / 4);
  const auto room = static_cast<std::size_t>(rounded_up(size_) + kVector);
  if (light_.size() < room) {
    light_.resize(room);
    lead_.resize(room);
    calm_.resize(room);
  }
  gather(0, lead_);
  pick_calm_channel(run);
  judge(run);
  blend();
}

/// The last pixel is repeated to the end of the last vector and once more.
void LightWindow::gather(int channel, Bytes& out) const {
  const std::uint8_t* p = profile_.at[static_cast<std::size_t>(channel)] + begin_ * profile_.step;
  std::uint8_t* o = out.data();
  // Copies: writing bytes may change anything, as far as the compiler knows.
  const int n = size_;
  const std::ptrdiff_t step = profile_.step;
  for (int i = 0; i < n; ++i, p += step) o[i] = *p;
  std::fill(o + n, o + rounded_up(n) + kVector, o[n - 1]);
}

/// Of the channels in which the laser does not shine the one that it raises least, against the colour of the
/// scene.
void LightWindow::pick_calm_channel(Run run) {
  const int middle = (run.first + run.last) / 2 - begin_;
  float least = 0;
  calm_channel_ = 0;
  for (int c = 1; c < 3; ++c) {
    const auto k = static_cast<std::size_t>(c);
    if (lit_[k] || scene_[k] < kDark) continue;
    const int around =
        value(c, std::max(middle - 1, 0)) + value(c, middle) + value(c, std::min(middle + 1, size_ - 1));
    const float rise = static_cast<float>(around) / scene_[k];
    if (calm_channel_ == 0 || rise < least) calm_channel_ = c, least = rise;
  }
}

float LightWindow::flank_mean(const Bytes& bytes) const {
  const std::uint8_t *a = bytes.data(), *b = a + size_ - 1;
  int sum = 0;
  for (int i = 0; i < kFlank && i < flank_; ++i) sum += a[i] + b[-i];  // at most kFlank: no vectors
  return static_cast<float>(sum) / static_cast<float>(2 * flank_);
}

float LightWindow::run_mean(const Bytes& bytes, Run run) const {
  int sum = 0;
  for (int i = run.first; i <= run.last; ++i) sum += bytes[static_cast<std::size_t>(i - begin_)];
  return static_cast<float>(sum) / static_cast<float>(run.length());
}

ChannelMeans LightWindow::flanks() const {
  ChannelMeans mean{};
  for (int c = 0; c < 3; ++c) {
    int sum = 0;
    for (int i = 0; i < kFlank && i < flank_; ++i) sum += value(c, i) + value(c, size_ - 1 - i);
    mean[static_cast<std::size_t>(c)] = static_cast<float>(sum) / static_cast<float>(2 * flank_);
  }
  return mean;
}

void LightWindow::judge(Run run) {
  mix_ = calm_mix_ = {};
  structure_ = 0;
  patch_ = false;
  const int saturated = count_from(lead_.data(), rounded_up(size_), saturation_level_);
  clipped_ = saturated >= kClipped;
  const bool colourless = lit_[0] && lit_[1] && lit_[2];
  if (clipped_ && !colourless) mix_ = {1, 1};
  if (calm_channel_ == 0) return;
  gather(calm_channel_, calm_);
  const float calm_flanks = flank_mean(calm_);
  patch_ = 2 * calm_flanks < run_mean(calm_, run);
  // Near saturation the other channels rise with the laser: subtracting them would carve out the line's core.
  const auto k = static_cast<std::size_t>(calm_channel_);
  const float ambient = patch_ ? scene_[k] : calm_flanks;
  if (saturated > 0 || ambient < kDark) return;
  const float lead_ambient = patch_ ? scene_[0] : flank_mean(lead_);
  calm_mix_[k - 1] = -std::min(kMostScale, lead_ambient / ambient);
  structure_ = range_of(calm_.data(), rounded_up(size_));
  constexpr float kLeast = 8;
  if (structure_ > kLeast && structure_ > range_of(lead_.data(), rounded_up(size_)) / 5 + kLeast)
    mix_ = calm_mix_;
}

void LightWindow::blend() {
  const std::uint8_t* lead = lead_.data();
  std::int16_t* light = light_.data();
  const int n = rounded_up(size_);
  for (int i = 0; i < n; ++i) light[i] = lead[i];
  for (std::size_t m = 0; m < 2; ++m) {
    if (mix_[m] == 0) continue;
    for (int i = 0; i < size_; ++i)
      light[i] = static_cast<std::int16_t>(
          light[i] + static_cast<int>(mix_[m] * static_cast<float>(value(static_cast<int>(m) + 1, i))));
  }
  int left = 0, right = 0;
  for (int i = 0; i < kFlank && i < flank_; ++i) {
    left += light[i];
    right += light[size_ - 1 - i];
  }
  background_ = std::max(left, right) / flank_;
}

}  // namespace linescope
