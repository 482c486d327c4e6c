#include "tools/calibrate/time_step.hpp"

#include <fmt/format.h>

#include "tools/calibrate/camera_match.hpp"
#include "tools/calibrate/tool_plots.hpp"

namespace linescope::calibrate {
namespace {

std::vector<TimedBoardView> views_of(const Session& session) {
  std::vector<TimedBoardView> views;
  for (const Observation& o : session.observations) {
    if (!o.board.empty()) views.push_back({o.name, o.time, o.board});
  }
  return views;
}

std::vector<PoseSample> endoscope_poses(const Session& session) {
  if (session.stations.endoscope < 0) return {};
  return session.poses.at(static_cast<std::size_t>(session.stations.endoscope));
}

Quality quality_of(const LatencyFit& fit, const Session& session, const Calibration& before) {
  Quality q;
  q.offered = session.offered;
  q.used = fit.names.size();
  q.left_out = session.left_out;
  q.unit = "px";
  q.residual = fit.residual_px;
  q.held_out = fit.held_out_px;
  q.held_out_count = fit.held_out;
  for (std::size_t i = 0; i < fit.names.size(); ++i)
    q.items.push_back({fit.names[i], fit.error_px[i], fit.used[i], 4});
  q.parameters = {{"latency", milliseconds_from(fit.latency), fit.deviation_ms, "ms"}};
  q.spread = {{"turning, RMS", fit.turn_deg_per_s, kUnknown, "deg/s"},
              {"correlation at its peak", fit.correlation, kUnknown, ""},
              {"latency by correlation alone", fit.coarse_ms, kUnknown, "ms"}};
  const auto apart = fit.endoscope_from_camera.inverse() * before.endoscope_from_camera;
  q.remarks.push_back(
      fmt::format("The hand-eye that this motion shows lies {:.2f} mm from the one in use; it is not stored.",
                  apart.translation().norm()));
  return q;
}

}  // namespace

void TimeStep::declare(ConfigSchema& schema) {
  LatencyOptions& o = options_;
  schema.section("time", "Latency of the camera on the tracker's clock.");
  schema.integer("time.least_pictures", o.least_pictures, {.min = 20, .max = 100000},
                 "Pictures with the board that are needed.");
  schema.integer("time.most_pictures", o.most_pictures, {.min = 0, .max = 100000},
                 "Enough pictures with the board; 0: until --seconds are over or the recording ends.");
  schema.number("time.range_ms", o.range_ms, {.unit = "ms", .min = 10, .max = 1000},
                "Latencies are looked for up to this, to both sides.");
  schema.number("time.least_turn_deg_per_s", o.least_turn_deg_per_s,
                {.unit = "deg/s", .min = 0.1, .max = 1000}, "RMS speed of turning that is needed.");
  schema.number("time.least_correlation", o.least_correlation, {.min = 0.5, .max = 0.999},
                "Weaker correlations between camera and tracker are refused.");
  schema.number("time.most_deviation_ms", o.most_deviation_ms, {.unit = "ms", .min = 0.01, .max = 100},
                "Limit of the latency's standard deviation.");
  schema.number("time.most_rms_px", o.most_rms_px, {.unit = "px", .min = 0.1, .max = 100},
                "Limit of the corners' RMS error.");
}

CollectOptions TimeStep::wants(const BoardOptions& board) const {
  CollectOptions wanted;
  wanted.board = board;
  wanted.most_pictures = static_cast<std::size_t>(options_.most_pictures);
  return wanted;
}

std::string TimeStep::coverage(const Session& so_far, const BoardOptions&) const {
  return fmt::format("{} of {} pictures with the board", so_far.observations.size(), so_far.offered);
}

Result<Outcome> TimeStep::run(const Session& session, const BoardOptions& board,
                              const Calibration& before) const {
  if (auto ok = fits_camera(session, before.camera); !ok) return tl::unexpected(ok.error());
  const auto fit = fit_latency(views_of(session), endoscope_poses(session), board, before, options_);
  if (!fit) return tl::unexpected(fit.error());
  Outcome outcome;
  outcome.method =
      "cross-correlation of turn rates, then latency, hand-eye and board together by least squares in the "
      "picture";
  outcome.quality = quality_of(*fit, session, before);
  if (auto ok = above_limit(*fit, options_); !ok) outcome.refused = ok.error();
  outcome.plots.push_back(plot_latency(*fit, endoscope_poses(session)));
  outcome.put = [latency = fit->latency](Calibration& c) {
    const std::string previous = fmt::format("{:.3f} ms", milliseconds_from(c.camera_latency));
    c.camera_latency = latency;
    return previous;
  };
  return outcome;
}

}  // namespace linescope::calibrate
