#include "tools/studies/navigation_study.hpp"

#include <algorithm>
#include <cmath>

#include "acquire/twin/timeline.hpp"
#include "common/units.hpp"
#include "tools/evaluate/surfaces.hpp"
#include "tools/studies/navigation_study_scan.hpp"
#include "tools/studies/navigation_study_spots.hpp"
#include "viewer/navigate/angle_difference.hpp"
#include "viewer/navigate/spot_experiment.hpp"
#include "viewer/navigate/triangle_locator.hpp"

namespace linescope::study {
namespace {

/// A clock that did not start with zero shows what takes a time for a duration.
constexpr Nanoseconds kStart = 1000 * kSecond;

twin::TwinOptions experiment_options(const StudyCondition& condition, const NavigationStudyOptions& options,
                                     int number) {
  twin::TwinOptions twin = condition.twin;
  twin.seed = options.first_seed + static_cast<std::uint64_t>(number);
  twin.start = kStart;
  twin.duration = 0;
  twin.hand.spots = options.spots;
  return twin;
}

/// Until the last sweep is over.
Nanoseconds scan_duration(const twin::HandOptions& hand) {
  const twin::Timeline timeline(hand);
  Nanoseconds t = 0;
  while (!twin::scanning(timeline.at(seconds_from(t)).phase)) t += 10 * kMillisecond;
  while (twin::scanning(timeline.at(seconds_from(t)).phase)) t += 10 * kMillisecond;
  return t;
}

StudyErrors errors_of(const SpotReport& report, const std::vector<Spot>& spots,
                      const NormalEstimator& estimator, NormalMethod method) {
  StudyErrors errors;
  errors.asked = report.asked;
  errors.refused = report.refused;
  for (std::size_t i = 0; i < spots.size(); ++i) {
    const SpotResult& result = report.spots[i];
    if (result.reason != NormalReason::none) continue;
    errors.normal_error.push_back(degrees_from_radians(result.normal_error));
    errors.angle_error.push_back(degrees_from_radians(result.angle_error));
    errors.cone_holds += result.cone_holds;
    errors.interval_holds += result.interval_holds;
    if (method != NormalMethod::robust) continue;
    const NormalEstimate e = estimator.estimate(spots[i].query, method);
    errors.interval_width += degrees_from_radians(e.angle_high - e.angle_low);
  }
  return errors;
}

/// The surface the viewer draws, asked for the normal of its triangle nearest to the tip.
class MeshNormals {
 public:
  explicit MeshNormals(const HeldLines& lines)
      : mesh_(evaluate::surface_of(lines, evaluate::kBetterMesh).mesh) {
    locator_.assign(mesh_);
  }

  std::optional<Eigen::Vector3d> near(const Eigen::Vector3d& tip) const {
    const auto found = locator_.nearest(tip.cast<float>(), 5.0f);
    if (!found) return std::nullopt;
    const auto& t = mesh_.triangles[found->owner];
    const auto corner = [&](std::size_t i) -> Eigen::Vector3d {
      return mesh_.positions[t[i]].cast<double>();
    };
    return (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized();
  }

  StudyErrors errors(const std::vector<Spot>& spots) const {
    StudyErrors errors;
    for (const Spot& spot : spots) {
      ++errors.asked;
      const auto normal = near(spot.query.tip);
      if (!normal) {
        ++errors.refused[static_cast<std::size_t>(NormalReason::no_surface)];
        continue;
      }
      const double truth = angle_difference(spot.true_normal, spot.true_axis);
      errors.normal_error.push_back(degrees_from_radians(angle_difference(*normal, spot.true_normal)));
      errors.angle_error.push_back(degrees_from_radians(angle_difference(*normal, spot.query.axis) - truth));
    }
    return errors;
  }

 private:
  TriangleMesh mesh_;
  TriangleLocator locator_;
};

/// One experiment: scan, spots, all methods.
Result<void> run_one(const twin::TwinOptions& options, Nanoseconds mean_over,
                     const NormalEstimatorOptions& estimator_options, NavigationRow& row) {
  twin::TwinOptions scanned = options;
  scanned.duration = scan_duration(options.hand);
  auto scan = scan_twin(scanned, mean_over);
  if (!scan) return tl::unexpected(scan.error());
  auto experiment = twin::VirtualExperiment::create(options);
  if (!experiment) return tl::unexpected(experiment.error());
  const std::vector<Spot> spots = stand_on_spots(*experiment, scan->calibration);
  NormalEstimatorOptions stated = estimator_options;
  stated.robust.unseen =
      Unseen::of_field(options.tracker.field_position_mm, options.tracker.field_rotation_rad);
  const NormalEstimator estimator = evaluate::estimator_of(scan->lines, stated);
  for (const NormalMethod method : {NormalMethod::robust, NormalMethod::algorithm_1}) {
    const SpotReport report = run_spots(estimator, spots, method);
    (method == NormalMethod::robust ? row.robust : row.algorithm_1)
        .add(errors_of(report, spots, estimator, method));
  }
  row.mesh.add(MeshNormals(scan->lines).errors(spots));
  row.lines += static_cast<double>(scan->lines.size());
  ++row.experiments;
  return {};
}

}  // namespace

void StudyErrors::add(const StudyErrors& more) {
  asked += more.asked;
  for (std::size_t i = 0; i < refused.size(); ++i) refused[i] += more.refused[i];
  normal_error.insert(normal_error.end(), more.normal_error.begin(), more.normal_error.end());
  angle_error.insert(angle_error.end(), more.angle_error.begin(), more.angle_error.end());
  cone_holds += more.cone_holds;
  interval_holds += more.interval_holds;
  interval_width += more.interval_width;
}

ErrorSummary summary(const std::vector<double>& errors) {
  ErrorSummary s;
  if (errors.empty()) return s;
  std::vector<double> sizes;
  for (const double e : errors) sizes.push_back(std::abs(e));
  std::sort(sizes.begin(), sizes.end());
  const auto n = static_cast<double>(sizes.size());
  for (const double e : sizes) s.mean += e / n;
  for (const double e : sizes) s.deviation += (e - s.mean) * (e - s.mean);
  s.deviation = sizes.size() > 1 ? std::sqrt(s.deviation / (n - 1)) : 0;
  s.smallest = sizes.front();
  s.largest = sizes.back();
  s.percentile_95 = sizes[static_cast<std::size_t>(std::ceil(0.95 * n)) - 1];
  return s;
}

Result<NavigationRow> run_navigation_study(const StudyCondition& condition,
                                           const NavigationStudyOptions& options) {
  NavigationRow row;
  row.name = condition.name;
  for (int i = 0; i < options.seeds; ++i)
    if (auto ok =
            run_one(experiment_options(condition, options, i), condition.mean_over, options.estimator, row);
        !ok)
      return tl::unexpected(ok.error());
  row.lines /= std::max(1, row.experiments);
  return row;
}

}  // namespace linescope::study
