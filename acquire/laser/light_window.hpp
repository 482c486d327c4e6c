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
  /// Reads the run and some surroundings. `colour` says which channels may be subtracted (mono: none),
  /// `scene` is the mean of the picture without the laser.
  void read(const Profile& profile, Run run, LaserColour colour, const ChannelMeans& scene,
            int saturation_level);

  int begin() const { return begin_; }  ///< pixel of the profile at index 0
  int size() const { return static_cast<int>(light_.size()); }
  int light(int i) const { return light_[static_cast<std::size_t>(i)]; }
  int channel(int c, int i) const {
    return channels_[static_cast<std::size_t>(c)][static_cast<std::size_t>(i)];
  }
  const LightMix& mix() const { return mix_; }

  /// The mix that takes the ambient light out, and how much structure (grey levels) the subtracted channel
  /// has here. Where that is large against the line it is mix() already; where it is merely more than noise
  /// it pays for the last step.
  const LightMix& calm_mix() const { return calm_mix_; }
  float structure() const { return structure_; }
  bool clipped() const { return clipped_; }
  int background() const { return background_; }  ///< of the light: the brighter flank

  /// The few pixels at both ends of the window.
  int flank() const { return flank_; }  ///< how many at each end
  const ChannelMeans& flanks() const { return flanks_; }

  /// What white looks like here: the flanks, or the whole scene where these are much darker than the run
  /// between them (a bright patch among dark ones).
  const ChannelMeans& ambient() const { return ambient_; }

 private:
  void gather(const Profile& profile, Run run);
  void choose_mix(Run run, LaserColour colour, const ChannelMeans& scene, int saturation_level);
  int calmest_channel(const ChannelMeans& inside, LaserColour colour) const;
  ChannelMeans means(Run run) const;
  float range(int c) const;
  void blend();

  int begin_ = 0, flank_ = 0, background_ = 0;
  bool clipped_ = false;
  float structure_ = 0;
  LightMix mix_{}, calm_mix_{};
  ChannelMeans flanks_{}, ambient_{};
  std::array<std::vector<int>, 3> channels_;
  std::vector<int> light_;
};

}  // namespace linescope
