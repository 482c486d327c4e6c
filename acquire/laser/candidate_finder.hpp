// From the runs of a profile to candidates with middle, width and height.
#pragma once

#include <span>
#include <vector>

#include "acquire/laser/candidate.hpp"
#include "acquire/laser/noise_meter.hpp"
#include "acquire/laser/picture_view.hpp"
#include "acquire/laser/run_finder.hpp"

namespace linescope {

/// Judges shape and colour of each run on its own; noise and neighbours come later. Rejected candidates are
/// kept, with their fault, because somebody may want to know.
class CandidateFinder {
 public:
  explicit CandidateFinder(const LineExtractorOptions& options) : options_(options) {}

  /// Appends the candidates of one profile, in ascending order of their middle. `runs` are merged in place
  /// where a white core separates them. `use_colour` false for grey pictures.
  void find(const Profile& profile, int index, std::span<Run> runs, bool use_colour,
            std::vector<Candidate>& out, NoiseMeter& noise);

 private:
  struct Window;
  struct Hump;
  void by_mean(const Profile& profile, int index, Run run, std::vector<Candidate>& out);
  void by_shape(const Profile& profile, int index, Run run, bool use_colour, std::vector<Candidate>& out,
                NoiseMeter& noise);
  void gather(const Profile& profile, Run run);
  void sum_channels(const Profile& profile);
  int highest(int from, int to, int box) const;
  Hump hump_at(int peak, int base) const;
  bool laser_coloured(const Profile& profile, const Hump& hump) const;
  Candidate candidate_from(const Profile& profile, int index, const Hump& hump, bool use_colour) const;
  std::size_t merge_across_cores(const Profile& profile, std::span<Run> runs) const;

  LineExtractorOptions options_;
  int begin_ = 0;  ///< profile index of light_[0]
  bool all_channels_ = false;
  std::vector<int> light_;  ///< of the window
};

}  // namespace linescope
