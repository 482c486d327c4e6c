#include <algorithm>
#include <functional>

#include "tools/evaluate/sections.hpp"
#include "tools/evaluate/setups.hpp"
#include "tools/evaluate/surfaces.hpp"
#include "tools/evaluate/virtual_session.hpp"
#include "viewer/navigate/normal_estimator.hpp"

namespace linescope::evaluate {
namespace {

constexpr int kRepeats = 5;
constexpr double kArea = 200;  // mm^2, as in Fig 5.6

/// Median of some runs, s.
double seconds_of(const std::function<void()>& work) {
  std::vector<double> times;
  for (int i = 0; i < kRepeats; ++i) {
    const Nanoseconds begin = monotonic_now();
    work();
    times.push_back(seconds_from(monotonic_now() - begin));
  }
  return box_of(times).median;
}

/// Area the line sweeps over per second: its mean length times the hand's mean speed along the site.
double area_per_second(const HeldLines& lines, const twin::TwinOptions& options) {
  double length = 0;
  for (const auto& line : lines)
    length += static_cast<double>((line->points.front().position - line->points.back().position).norm());
  length /= static_cast<double>(lines.size());
  return length * options.phantom.site_length_mm / options.hand.sweep_seconds;
}

double one_normal(const HeldLines& lines, const NormalEstimator& estimator, NormalMethod method) {
  const auto& line = *lines[lines.size() / 2];
  NormalQuery query;
  query.tip = line.points[line.points.size() / 2].position.cast<double>();
  query.axis = line.seen_from - query.tip;
  query.now = lines.back()->time;
  constexpr int kCalls = 20;
  return seconds_of([&] {
           for (int i = 0; i < kCalls; ++i) static_cast<void>(estimator.estimate(query, method));
         }) /
         kCalls;
}

std::optional<Estimate> single(double value) {
  return estimate({value});
}

}  // namespace

Sections timing_sections(const Form& form) {
  twin::TwinOptions options = sweeping_freely(system_ii(1), 3 * form.scan_seconds);
  options.phantom = phantom("condyle");
  auto session = VirtualSession::render(options);
  if (!session) return tl::unexpected(session.error());
  const SessionOptions run = better_session();
  const Nanoseconds begin = monotonic_now();
  auto scan = session->acquire(run);
  if (!scan) return tl::unexpected(scan.error());
  const double per_picture = seconds_from(monotonic_now() - begin) / static_cast<double>(session->pictures());
  if (scan->lines.empty()) return fail(ErrorCode::internal, "the scan that is to be timed has no line");

  const double sweep = kArea / area_per_second(scan->lines, options);
  const double plain_mesh = seconds_of([&] { static_cast<void>(surface_of(scan->lines, kThesisMesh)); });
  const double better_mesh = seconds_of([&] { static_cast<void>(surface_of(scan->lines, kBetterMesh)); });
  const NormalEstimator estimator = estimator_of(scan->lines);
  const double plain_normal = one_normal(scan->lines, estimator, NormalMethod::algorithm_1);
  const double better_normal = one_normal(scan->lines, estimator, NormalMethod::robust);
  Table table{"timing", "Fig 5.6: time consumption on this machine", {}, {}};
  table.rows = {{"scan of 200 mm2 (the hand's speed: simulated)", "s", 1.47, single(sweep), single(sweep)},
                {"grid and mesh of the whole scan", "s", 2.41, single(plain_mesh), single(better_mesh), 3},
                {"one normal", "ms", {}, single(1e3 * plain_normal), single(1e3 * better_normal), 3},
                {"until navigation: scan, mesh, normal", "s", 4.4, single(sweep + plain_mesh + plain_normal),
                 single(sweep + better_mesh + better_normal)},
                {"daemon, per picture", "ms", {}, {}, single(1e3 * per_picture)},
                {"points in the scan", "", 94'000, {}, single(static_cast<double>(scan->points())), 0}};
  table.notes = {
      "The only table whose figures change from run to run. The thesis's 2.41 s include drawing; ours are "
      "without it "
      "and build the mesh at once from all lines, where the viewer keeps it up to date while the scan grows. "
      "The scan's time is a choice of the simulated hand, not a measurement."};
  return std::vector<Section>{{std::move(table), {}}};
}

}  // namespace linescope::evaluate
