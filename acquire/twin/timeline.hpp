// What the operator does when: the phases of a scenario, repeated for ever.
#pragma once

#include <vector>

#include "acquire/twin/hand_options.hpp"

namespace linescope::twin {

enum class Phase {
  approach,  ///< endoscope from its rest to the site
  sweep,     ///< line over the site
  withdraw,  ///< endoscope back to its rest
  travel,    ///< harvester to a spot
  tilt,      ///< harvester on the spot, turning towards the normal
  hold,      ///< harvester on the spot, as good as the operator gets it
  leave,     ///< harvester back to its rest
  stand,     ///< endoscope over the middle of the site, still
  board,     ///< endoscope from view to view of the board
  shake,     ///< endoscope to and fro before the board
  pivot,     ///< harvester about its tip
  spin,      ///< harvester about its axis
};

struct Moment {
  Phase phase = Phase::stand;
  double since = 0;   ///< s, since the phase began
  double length = 1;  ///< s, of the phase
  int spot = -1;      ///< of travel, tilt, hold

  double fraction() const { return since / length; }
};

/// True in the phases in which the line crosses the site on purpose.
constexpr bool scanning(Phase phase) {
  return phase == Phase::sweep || phase == Phase::stand;
}

class Timeline {
 public:
  explicit Timeline(const HandOptions& options);

  /// `seconds` >= 0 since the beginning of the experiment.
  Moment at(double seconds) const;

  /// Length of one round, s.
  double round() const { return total_; }

 private:
  void add(Phase phase, double seconds, int spot = -1);
  void add_spots(const HandOptions& options);

  std::vector<Moment> phases_;
  double total_ = 0;
};

}  // namespace linescope::twin
