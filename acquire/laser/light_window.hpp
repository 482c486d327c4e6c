// The light of the laser along a piece of one profile, with the ambient light taken out where it has
// structure.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "acquire/laser/picture_view.hpp"
#include "acquire/laser/run_finder.hpp"

namespace linescope {

/// How much of the second and third channel (in the order of Profile) belongs to the light beside all of the
/// first.
///  * (0, 0): the laser's channel alone, which has the least noise. The rule.
///  * (1, 1): the laser's channel is clipped, so the other two know better where the middle is.
///  * one of them negative: an edge, a lamp's reflection or a printed pattern lies at the line. The channel
///  in
///    which the laser shines least shows it too and is subtracted, scaled so that the surroundings vanish.
using LightMix = std::array<float, 2>;

/// Mean grey levels of the three channels, in the order of Profile.
using ChannelMeans = std::array<float, 3>;

class LightWindow {
 public:
  /// Starts a picture. `colour` says which channels may be subtracted (mono: none), `scene` is the mean of
  /// the picture without the laser.
  void start(LaserColour colour, const ChannelMeans& scene, int saturation_level);

  /// Reads the run and some surroundings.
  void read(const Profile& profile, Run run);

  int begin() const { return begin_; }  ///< pixel of the profile at index 0
  int size() const { return size_; }
  int lead(int i) const { return lead_[static_cast<std::size_t>(i)]; }     ///< the laser's channel
  int light(int i) const { return light_[static_cast<std::size_t>(i)]; }   ///< the mix
  int value(int c, int i) const { return profile_.value(c, begin_ + i); }  ///< any channel
  int background() const { return background_; }  ///< of the light: the brighter flank
  bool clipped() const { return clipped_; }
  const LightMix& mix() const { return mix_; }

  /// The mix that takes the ambient light out, and how much structure (grey levels) the subtracted channel
  /// has here. Where that is large against the line it is mix() already; where it is merely more than noise
  /// it pays for the last step.
  const LightMix& calm_mix() const { return calm_mix_; }
  float structure() const { return structure_; }

  /// How many pixels at each end count as surroundings, and their means.
  int flank() const { return flank_; }
  ChannelMeans flanks() const;

  /// What white looks like here: the flanks, or the whole scene where these are much darker than the run
  /// between them (a bright patch among dark ones).
  ChannelMeans ambient() const { return patch_ ? scene_ : flanks(); }

 private:
  using Bytes = std::vector<std::uint8_t>;
  void gather(int channel, Bytes& out) const;
  void pick_calm_channel(Run run);
  void judge(Run run);
  void blend();
  float flank_mean(const Bytes& bytes) const;
  float run_mean(const Bytes& bytes, Run run) const;

  std::array<bool, 3> lit_{};
  ChannelMeans scene_{};
  int saturation_level_ = 255;

  Profile profile_;
  int begin_ = 0, size_ = 0, flank_ = 0, background_ = 0;
  int calm_channel_ = 0;  ///< 0: none
  bool clipped_ = false, patch_ = false;
  float structure_ = 0;
  LightMix mix_{}, calm_mix_{};
  // As long as the longest window so far, rounded up; the loops over them run in whole vectors.
  Bytes lead_, calm_;
  std::vector<std::int16_t> light_;
};

}  // namespace linescope
