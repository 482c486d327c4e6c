// The thesis's navigation experiment (5.3) on the digital twin, through the product's own chain: rendered
// pictures, tracker samples, extraction, triangulation, segment, placing in the object's frame, meshing,
// normal.
//
// The harvester stands on marked spots; asked is what the viewer would show. Truth comes from the twin and is
// used for nothing but the errors.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "acquire/tracker/pose_history.hpp"
#include "acquire/twin/twin_options.hpp"
#include "common/result.hpp"
#include "viewer/navigate/normal_estimate.hpp"
#include "viewer/navigate/normal_estimator.hpp"

namespace linescope::study {

/// One row of the table.
struct StudyCondition {
  std::string name;                           ///< for people
  twin::TwinOptions twin;                     ///< seed, start and duration are set by the study
  Nanoseconds mean_over = 25 * kMillisecond;  ///< of a picture's pose; 0: interpolated only
};

/// The cylinder of the thesis with one, two and four sweeps, then one thing changed at a time: phantom,
/// missing line, blood, field distortion, gap.
std::vector<StudyCondition> navigation_conditions();

struct NavigationStudyOptions {
  int seeds = 20;                    ///< independent experiments per condition
  std::uint64_t first_seed = 1;      ///< experiments use this one and the following ones
  int spots = 30;                    ///< per experiment
  NormalEstimatorOptions estimator;  ///< its `unseen` is set to the field of the condition: that is stated
};

/// Degrees. Errors of answered spots only; the others are in `refused` by reason.
struct StudyErrors {
  int asked = 0;
  std::array<int, 16> refused{};     ///< by NormalReason
  std::vector<double> normal_error;  ///< between estimated and true normal, in the object's frame
  std::vector<double> angle_error;   ///< shown angle less true angle: the harvester's own pose errs, too
  int cone_holds = 0;                ///< true normal within the stated 95 % cone
  int interval_holds = 0;            ///< true angle within the stated 95 % interval
  double interval_width = 0;         ///< sum over the answered spots

  int answered() const { return static_cast<int>(normal_error.size()); }
  void add(const StudyErrors& more);
};

struct ErrorSummary {
  double mean = 0, deviation = 0, smallest = 0, largest = 0, percentile_95 = 0;
};
/// Of magnitudes; zeros when there are none.
ErrorSummary summary(const std::vector<double>& errors);

struct NavigationRow {
  std::string name;
  int experiments = 0;
  double lines = 0;         ///< mean per experiment
  StudyErrors robust;       ///< the estimate the viewer shows
  StudyErrors algorithm_1;  ///< the thesis's, on the same points
  StudyErrors mesh;  ///< normal of the mesh's triangle nearest to the tip (no interval, refuses beyond 5 mm)
};

/// Fails with the twin's or the chain's own sentence (for example: line out of the picture at this gap).
Result<NavigationRow> run_navigation_study(const StudyCondition& condition,
                                           const NavigationStudyOptions& options);

/// The same experiments with one source of error taken away at a time: what limits the condition is what
/// helps most.
struct LimitRow {
  std::string without;  ///< "nothing taken away", "no field distortion", ...
  ErrorSummary robust;  ///< of the normal's error, degrees
  int answered = 0, asked = 0;
};
Result<std::vector<LimitRow>> navigation_limits(const StudyCondition& condition,
                                                const NavigationStudyOptions& options);

/// Markdown: a head, then one line per row.
std::string navigation_table_head();
std::string navigation_table_line(const NavigationRow& row);
/// "edge of the scan 3, too uncertain 1"; empty when nothing was refused.
std::string refusals_text(const StudyErrors& errors);

}  // namespace linescope::study
