// From the runs of a profile to candidates with middle, width and height.
#pragma once

#include <span>
#include <vector>

#include "acquire/laser/candidate.hpp"
#include "acquire/laser/colour_excess.hpp"
#include "acquire/laser/hump.hpp"
#include "acquire/laser/noise_meter.hpp"
#include "acquire/laser/run_block.hpp"
#include "acquire/laser/run_finder.hpp"

namespace linescope {

/// Judges shape and colour of each run on its own; noise and neighbours come later. Rejected candidates are
/// kept, with their fault, because somebody may want to know.
///
/// Every eighth profile of an undisturbed line is looked at closely. In the profiles between them, the only
/// run (but for specks of a few pixels) takes over its neighbour's width and background where it lies as the
/// neighbour's did, to two pixels, well inside the profile, without saturation and clearly of the laser's
/// colour.
class CandidateFinder {
 public:
  /// `at_once`: profiles are taken several at a time where they allow it; the candidates are the same
  /// without.
  explicit CandidateFinder(const LineExtractorOptions& options, bool at_once = block_sums_known())
      : options_(options),
        excess_(options.colour),
        levels_{options.colour_threshold, options.saturation_level},
        limits_(options),
        at_once_(at_once) {}

  /// Starts a picture. `colour` is the laser's, or mono for grey pictures; `scene` the mean of the picture
  /// without the laser, in the order of Profile's channels.
  void begin(LaserColour colour, const ChannelMeans& scene);

  /// The candidates of all profiles, those of a profile in ascending order of their middle. Runs are merged
  /// where a white core separates them.
  void find(const PictureView& picture, const RunFinder& runs, CandidateList& out, NoiseMeter& noise);

 private:
  /// What a picture's profiles have in common.
  struct Source {
    const PictureView& picture;
    const RunFinder& runs;
    CandidateList& out;
    NoiseMeter& noise;
    int lead;
  };
  /// Several profiles from index_ on by vectors, as far as each has one run at most; false: not even one.
  bool find_means_at_once(const Source& source);
  bool follow_at_once(const Source& source);
  /// The profile index_, whatever it holds.
  void find_one(const Source& source);
  void find_means(const Source& source, const Profile& profile, std::span<const Run> runs);
  void find_shapes(const Source& source, const Profile& profile, std::span<const Run> runs);
  void close_look(Run run, CandidateList& out);
  bool follow(const Profile& profile, Run run, CandidateList& out);
  void begin_profile(CandidateList& out) const { out.first.push_back(static_cast<int>(out.all.size())); }
  Candidate candidate_from(const Hump& hump, int look) const;
  bool has_colour(const Hump& hump) const;
  bool rises_in_colour(const Hump& hump) const;
  int excess(int i) const { return excess_.of(window_.lead(i), window_.value(1, i), window_.value(2, i)); }

  /// What a following profile may rely on.
  struct Neighbour {
    int profile = -1;  ///< -1: none
    Run run;
    int candidate = 0;   ///< of the close look, in CandidateList::all
    int background = 0;  ///< grey levels
    int followers = 0;   ///< since the last close look
    bool before(int index) const { return profile >= 0 && profile == index - 1; }
  };
  Neighbour& next() { return neighbours_[static_cast<std::size_t>(index_ & 1)]; }
  const Neighbour& neighbour() const { return neighbours_[static_cast<std::size_t>(~index_ & 1)]; }
  bool continues(Run before, Run run) const;
  bool like_the_line(const LightSums& light) const;
  void add_follower(const Neighbour& n, Run run, const LightSums& light, CandidateList& out) const;

  LineExtractorOptions options_;
  ColourExcess excess_;
  MeanLevels levels_;
  ShapeLimits limits_;
  bool at_once_ = false;
  int length_ = 0;  ///< of the profiles
  int index_ = 0;
  LightWindow window_;
  RunBlock block_;  ///< of the profiles that are taken at once, and their sums
  RunMeanBlock means_;
  LightSumsBlock lights_;
  std::array<Neighbour, 2> neighbours_;  ///< of profiles with even and with odd index
};

}  // namespace linescope
