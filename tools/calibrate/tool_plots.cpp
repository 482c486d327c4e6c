#include "tools/calibrate/tool_plots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/units.hpp"
#include "tools/calibrate/chart.hpp"
#include "tools/calibrate/hand_eye_solve.hpp"
#include "tools/calibrate/sample_statistics.hpp"
#include "tools/calibrate/turn_correlation.hpp"

namespace linescope::calibrate {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

double seconds_since(const ToolPoses& poses, std::size_t i) {
  return seconds_from(poses[i].time - poses.front().time);
}

/// Error of every pose over time; those left out in red.
Chart over_time(const ToolPoses& poses, const std::vector<double>& error, const std::vector<bool>& used,
                std::string title, std::string up) {
  Chart chart{.title = std::move(title), .across = "time (s)", .up = std::move(up)};
  chart.height = 260;
  chart.series = {{.name = "used"}, {.name = "left out", .ink = Ink::red}};
  for (std::size_t i = 0; i < poses.size(); ++i)
    chart.series[used.empty() || used[i] ? 0 : 1].points.emplace_back(seconds_since(poses, i), error[i]);
  return chart;
}

/// The sheet of a globe on which the directions lie: degrees from their mean, to two sides.
std::vector<Vector2d> tilts_of(const std::vector<Vector3d>& directions) {
  Vector3d mean = Vector3d::Zero();
  for (const Vector3d& d : directions) mean += d;
  mean.normalize();
  const Vector3d u = mean.unitOrthogonal(), v = mean.cross(u);
  std::vector<Vector2d> tilts;
  for (const Vector3d& d : directions) {
    const Vector2d side(d.dot(u), d.dot(v));
    const double angle = degrees_from_radians(std::atan2(side.norm(), d.dot(mean)));
    tilts.emplace_back(side.norm() > 0 ? Vector2d(angle * side.normalized()) : side);
  }
  return tilts;
}

/// RMS distance of a tip from its own mean place: how it would wander if it were the tool's.
double wander(const ToolPoses& poses, const std::vector<bool>& used, const Vector3d& tip) {
  Vector3d sum = Vector3d::Zero();
  double squares = 0, count = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (!used[i]) continue;
    const Vector3d from_first =
        poses[i].fixture_from_tool * tip - poses.front().fixture_from_tool.translation();
    sum += from_first, squares += from_first.squaredNorm(), ++count;
  }
  return std::sqrt(std::max(0.0, squares / count - (sum / count).squaredNorm()));
}

double highest(const std::vector<double>& values) {
  return values.empty() ? 1 : std::max(1e-9, *std::max_element(values.begin(), values.end()));
}

double spin_deg(const Eigen::Quaterniond& turn, const Vector3d& axis) {
  return std::remainder(2 * degrees_from_radians(std::atan2(turn.vec().dot(axis), turn.w())), 360);
}

}  // namespace

Plot plot_pivot(const ToolPoses& poses, const PivotFit& fit, const Vector3d& tip_before) {
  std::vector<Vector3d> directions;
  for (const TimedToolPose& pose : poses)
    directions.push_back(-(pose.fixture_from_tool.rotation() * fit.tip).normalized());
  Chart swing{.title = "Pivoting: where the handle pointed, seen from the divot",
              .finding = fmt::format("{} poses; swing in its lesser direction {:.1f} deg RMS", poses.size(),
                                     fit.swing_deg),
              .across = "tilt to one side (deg)",
              .up = "tilt across it (deg)"};
  swing.series = {{.name = "", .points = tilts_of(directions), .values = fit.error}};
  swing.scale =
      ColourScale{"tip from divot (mm)", 0, fit.error.empty() ? 1 : std::max(1e-9, high_value(fit.error))};
  swing.same_scale = true;
  swing.height = 480;
  Chart time =
      over_time(poses, fit.error, fit.used, "Distance of the tip from the divot", "tip from divot (mm)");
  time.finding = fmt::format("RMS {:.3f} mm, held out {:.3f} mm; with the tip in use before: {:.3g} mm",
                             fit.residual_mm, fit.held_out_mm, wander(poses, fit.used, tip_before));
  return {"harvester-pivot", page({swing, time})};
}

Plot plot_spin(const ToolPoses& poses, const SpinFit& fit) {
  std::vector<double> wobble;
  for (const double rad : fit.error) wobble.push_back(degrees_from_radians(rad));
  Chart turn{.title = "Spinning: the axis against its mean, over the turn about it",
             .finding = fmt::format("{} poses; turn {:.0f} deg RMS", poses.size(), fit.spin_deg),
             .across = "turn about the axis since the first pose (deg)",
             .up = "axis from its mean (deg)"};
  turn.series = {{.name = "used"}, {.name = "left out", .ink = Ink::red}};
  const auto first = poses.front().fixture_from_tool.rotation().conjugate();
  for (std::size_t i = 0; i < poses.size(); ++i)
    turn.series[fit.used[i] ? 0 : 1].points.emplace_back(
        spin_deg(first * poses[i].fixture_from_tool.rotation(), fit.axis), wobble[i]);
  Chart time = over_time(poses, wobble, fit.used, "The same over time", "axis from its mean (deg)");
  time.finding = fmt::format("RMS {:.3f} deg, held out {:.3f} deg", degrees_from_radians(fit.residual_rad),
                             degrees_from_radians(fit.held_out_rad));
  return {"harvester-spin", page({turn, time})};
}

Plot plot_block(const ToolPoses& poses, const BlockOptions& block, const BlockFit& fit) {
  std::vector<double> tip, axis;
  for (const TimedToolPose& pose : poses) {
    const auto tool_from_fixture = pose.fixture_from_tool.inverse();
    tip.push_back((tool_from_fixture * block.tip - fit.tip).norm());
    const Vector3d held = tool_from_fixture.rotation() * block.axis.normalized();
    axis.push_back(degrees_from_radians(std::atan2(held.cross(fit.axis).norm(), held.dot(fit.axis))));
  }
  Chart places = over_time(poses, tip, {}, "Block: the tip about its mean", "tip from its mean (mm)");
  places.finding = fmt::format("RMS {:.3f} mm, held out {:.3f} mm", fit.residual_mm, fit.held_out_mm);
  Chart angles = over_time(poses, axis, {}, "Block: the axis about its mean", "axis from its mean (deg)");
  angles.finding = fmt::format("RMS {:.3f} deg, held out {:.3f} deg", degrees_from_radians(fit.residual_rad),
                               degrees_from_radians(fit.held_out_rad));
  return {"harvester-block", page({places, angles})};
}

namespace {

constexpr Nanoseconds kWindow = 1500 * kMillisecond;

/// The stretch of `kWindow` in which the turn rates change most.
std::pair<Nanoseconds, Nanoseconds> liveliest(const std::vector<TurnOver>& turns) {
  double most = -1;
  Nanoseconds best = turns.front().from;
  for (std::size_t first = 0; first < turns.size(); ++first) {
    double change = 0;
    for (std::size_t i = first + 1; i < turns.size() && turns[i].to - turns[first].from <= kWindow; ++i)
      change += std::abs(turns[i].rate() - turns[i - 1].rate());
    if (change > most) most = change, best = turns[first].from;
  }
  return {best, best + kWindow};
}

Series camera_rates(const std::vector<TurnOver>& turns, std::pair<Nanoseconds, Nanoseconds> window,
                    Nanoseconds shift) {
  Series series{.name = "camera", .ink = Ink::orange, .joined = true};
  for (const TurnOver& turn : turns) {
    if (turn.from < window.first || turn.to > window.second) continue;
    const Nanoseconds middle = turn.from + (turn.to - turn.from) / 2 - shift;
    series.points.emplace_back(seconds_from(middle - window.first), degrees_from_radians(turn.rate()));
  }
  return series;
}

/// Turning of the sensor over steps as long as those of the camera, at ten times as many instants.
Series tracker_rates(const PoseTrack& track, std::pair<Nanoseconds, Nanoseconds> window, Nanoseconds step) {
  Series series{.name = "tracker", .ink = Ink::blue, .joined = true};
  for (Nanoseconds t = window.first; t <= window.second; t += std::max<Nanoseconds>(1, step / 10)) {
    const auto from = track.at(t - step / 2), to = track.at(t + step / 2);
    if (!from || !to) continue;
    const double rad = from->rotation().angularDistance(to->rotation());
    series.points.emplace_back(seconds_from(t - window.first),
                               degrees_from_radians(rad) / seconds_from(step));
  }
  return series;
}

Chart motion(const LatencyFit& fit, const PoseTrack& track, Nanoseconds shift, std::string title) {
  const auto window = liveliest(fit.turns);
  Chart chart{.title = std::move(title), .across = "time (s)", .up = "turning (deg/s)"};
  chart.series = {tracker_rates(track, window, fit.turns.front().to - fit.turns.front().from),
                  camera_rates(fit.turns, window, shift)};
  chart.finding = fmt::format("correlation {:.4f} over all pictures",
                              correlation_at(fit.turns, track, shift).value_or(kUnknown));
  chart.height = 270;
  return chart;
}

Chart correlation_chart(const LatencyFit& fit, const PoseTrack& track) {
  Chart chart{
      .title = "Agreement of both over the latency that is assumed",
      .finding = fmt::format("latency {:.2f} +- {:.2f} ms", milliseconds_from(fit.latency), fit.deviation_ms),
      .across = "latency (ms)",
      .up = "correlation",
      .series = {{.name = "correlation", .joined = true}, {.name = "found", .ink = Ink::red}}};
  constexpr int kReach = 100;
  for (int ms = -kReach; ms <= kReach; ms += 2)
    if (const auto c = correlation_at(fit.turns, track, ms * kMillisecond))
      chart.series[0].points.emplace_back(ms, *c);
  if (const auto c = correlation_at(fit.turns, track, fit.latency))
    chart.series[1].points.emplace_back(milliseconds_from(fit.latency), *c);
  chart.height = 240;
  return chart;
}

std::vector<double> errors_of(const HandEyePictures& pictures, const HandEyeSolution& chain,
                              const BoardOptions& board) {
  std::vector<double> errors;
  for (const HandEyePicture* p : pictures) errors.push_back(chain_error(*p, chain, board));
  return errors;
}

Chart per_picture(const std::vector<double>& errors, std::string title, Ink ink) {
  Chart chart{.title = std::move(title), .across = "picture", .up = "board's corners off (mm)"};
  chart.height = 240;
  chart.series = {{.name = "", .ink = ink}};
  double squares = 0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    chart.series[0].points.emplace_back(static_cast<double>(i + 1), errors[i]);
    squares += errors[i] * errors[i];
  }
  chart.from_zero = true;
  chart.finding = fmt::format("RMS {:.3g} mm, largest {:.3g} mm",
                              std::sqrt(squares / static_cast<double>(errors.size())), highest(errors));
  return chart;
}

Chart over_place(const HandEyePictures& pictures, const std::vector<double>& errors) {
  Chart chart{
      .title = "The same over the place of the endoscope's sensor",
      .finding = "errors that grow towards one side: metal near by, or the edge of the tracker's range",
      .across = "x in the tracker's frame (mm)",
      .up = "y (mm)"};
  chart.series = {{.name = "", .values = errors}};
  for (const HandEyePicture* p : pictures)
    chart.series[0].points.emplace_back(p->base_from_endoscope.translation().head<2>());
  chart.scale = ColourScale{"corners off (mm)", 0, highest(errors)};
  chart.same_scale = true;
  chart.height = 400;
  return chart;
}

}  // namespace

Plot plot_latency(const LatencyFit& fit, const std::vector<PoseSample>& poses) {
  const PoseTrack track(poses);
  const Chart before = motion(fit, track, 0, "Before: camera by its time stamps, against the tracker");
  const Chart after =
      motion(fit, track, fit.latency,
             fmt::format("After: the camera moved by {:.2f} ms", -milliseconds_from(fit.latency)));
  return {"time-motion", page({before, after, correlation_chart(fit, track)})};
}

Plot plot_hand_eye(const HandEyeFit& fit, const BoardOptions& board,
                   const Rigid<Endoscope, CameraCv>& before) {
  const HandEyePictures pictures = all_of(fit.pictures);
  HandEyeSolution old, found;
  old.endoscope_from_camera = before;
  old.base_from_board = mean_board(pictures, before);
  found.endoscope_from_camera = fit.endoscope_from_camera;
  found.base_from_board = fit.base_from_board;
  const auto after = errors_of(pictures, found, board);
  return {"hand-eye-before-after", page({per_picture(errors_of(pictures, old, board),
                                                     "Before: with the hand-eye in use so far", Ink::grey),
                                         per_picture(after, "After: with the one found now", Ink::blue),
                                         over_place(pictures, after)})};
}

}  // namespace linescope::calibrate
