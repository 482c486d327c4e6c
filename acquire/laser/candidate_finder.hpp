// From the runs of a profile to candidates with middle, width and height.
#pragma once

#include <span>
#include <vector>

#include "acquire/laser/candidate.hpp"
#include "acquire/laser/hump.hpp"
#include "acquire/laser/light_window.hpp"
#include "acquire/laser/noise_meter.hpp"
#include "acquire/laser/run_finder.hpp"

namespace linescope {

/// Judges shape and colour of each run on its own; noise and neighbours come later. Rejected candidates are
/// kept, with their fault, because somebody may want to know.
class CandidateFinder {
 public:
  explicit CandidateFinder(const LineExtractorOptions& options) : options_(options) {}

  /// Starts a picture. `colour` is the laser's, or mono for grey pictures; `scene` the mean of the picture
  /// without the laser, in the order of Profile's channels.
  void begin(LaserColour colour, const ChannelMeans& scene) {
    colour_ = colour;
    scene_ = scene;
  }

  /// Appends the candidates of one profile, in ascending order of their middle. `runs` are merged in place
  /// where a white core separates them.
  void find(const Profile& profile, int index, std::span<Run> runs, std::vector<Candidate>& out,
            NoiseMeter& noise);

 private:
  std::size_t merge_across_cores(const Profile& profile, std::span<Run> runs) const;
  Candidate by_mean(const Profile& profile, Run run) const;
  void by_shape(Run run, std::vector<Candidate>& out);
  Candidate candidate_from(const Hump& hump) const;
  bool has_colour(const Hump& hump) const;
  bool rises_in_colour(const Hump& hump) const;
  int excess(int i) const;

  LineExtractorOptions options_;
  LaserColour colour_ = LaserColour::mono;
  ChannelMeans scene_{};
  int length_ = 0;  ///< of the profile
  int index_ = 0;
  LightWindow window_;
};

}  // namespace linescope
