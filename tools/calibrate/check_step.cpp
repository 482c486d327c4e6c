#include "tools/calibrate/check_step.hpp"

#include <fmt/format.h>

#include <cmath>

#include "acquire/reconstruct/line_reconstructor.hpp"
#include "tools/calibrate/check_plots.hpp"

namespace linescope::calibrate {
namespace {

/// Where the scan is held: the object's sensor at that instant, or the world.
PoseAnswer holder_at(const Session& session, Nanoseconds time, Nanoseconds latency) {
  if (session.stations.object >= 0 &&
      !session.poses.at(static_cast<std::size_t>(session.stations.object)).empty())
    return session.pose_at(session.stations.object, time, latency);
  PoseAnswer world;
  world.miss = PoseMiss::none;
  return world;
}

ScanLine in_holder(const ReconstructedLine& line, const PoseAnswer& holder) {
  const auto holder_from_world = holder.world_from_sensor.inverse();
  ScanLine points;
  for (const SurfacePoint& p : line.points) {
    const Eigen::Vector3d world(p.position.x(), p.position.y(), p.position.z());
    points.push_back(holder_from_world * world);
  }
  return points;
}

void add_shape(Outcome& outcome, const ShapeCheck& check) {
  Quality& q = outcome.quality;
  q.used = check.lines;
  q.unit = "mm";
  q.residual = check.residual_mm;
  q.held_out = check.target_error_mm;
  q.held_out_count = check.held_out_points;
  q.parameters = {{"bias", check.bias_mm, kUnknown, "mm"},
                  {"precision", check.precision_mm, kUnknown, "mm"},
                  {"repeatability", check.repeatability_mm, kUnknown, "mm"},
                  {"target registration error", check.target_error_mm, kUnknown, "mm"}};
  if (check.diameter_mm > 0) q.parameters.push_back({"fitted diameter", check.diameter_mm, kUnknown, "mm"});
  q.spread = {{"points", static_cast<double>(check.points), kUnknown, ""},
              {"passes", static_cast<double>(check.passes), kUnknown, ""},
              {"way of the scan", check.extent_mm, kUnknown, "mm"}};
}

void add_still(Quality& q, const std::vector<StillStation>& stations) {
  for (const StillStation& s : stations) {
    const std::string who = fmt::format("sensor {} at rest: ", s.station + 1);
    q.parameters.push_back({who + "jitter, RMS", s.jitter_mm, kUnknown, "mm"});
    q.parameters.push_back({who + "jitter, RMS", s.jitter_deg, kUnknown, "deg"});
    q.parameters.push_back({who + "drift", s.drift_mm, kUnknown, "mm"});
    if (std::isfinite(s.distortion))
      q.parameters.push_back({who + "metal indicator", s.distortion, kUnknown, ""});
  }
}

void add_pair(Quality& q, const PairCheck& check) {
  q.parameters.push_back({"metal test: distance of the pair, RMS difference", check.rms_mm, kUnknown, "mm"});
  q.parameters.push_back({"metal test: turn of the pair, RMS difference", check.rms_deg, kUnknown, "deg"});
  q.parameters.push_back({"metal test: largest difference", check.worst_mm, kUnknown, "mm"});
  q.spread.push_back({"metal test: places", static_cast<double>(check.places.size()), kUnknown, ""});
  q.spread.push_back({"metal test: places reach over", check.extent_mm, kUnknown, "mm"});
}

/// One more verdict: all that is wrong is told at once.
void judge(Outcome& outcome, const Result<void>& verdict) {
  if (verdict) return;
  if (outcome.refused)
    outcome.refused->message += " " + verdict.error().message;
  else
    outcome.refused = verdict.error();
}

}  // namespace

Result<std::vector<ScanLine>> placed_lines(const Session& session, const Calibration& calibration,
                                           std::vector<LeftOut>& left_out, ProfileAxis axis) {
  auto reconstructor = LineReconstructor::create(calibration, {});
  if (!reconstructor) return tl::unexpected(reconstructor.error());
  std::vector<ScanLine> lines;
  for (const Observation& o : session.observations) {
    if (o.line.empty()) continue;
    const auto endoscope = session.pose_at(session.stations.endoscope, o.time, calibration.camera_latency);
    const auto holder = holder_at(session, o.time, calibration.camera_latency);
    if (!endoscope.ok() || !holder.ok()) {
      const PoseMiss miss = endoscope.ok() ? holder.miss : endoscope.miss;
      left_out.push_back({o.name, fmt::format("no pose: {}", linescope::name(miss))});
      continue;
    }
    ExtractedLine line;
    line.width = session.width;
    line.height = session.height;
    line.axis = axis;
    line.samples = o.line;
    ReconstructedLine placed;
    const auto world_from_endoscope = renamed<World, Endoscope>(endoscope.world_from_sensor);
    if (auto ok = reconstructor->reconstruct(line, world_from_endoscope, placed); !ok)
      return tl::unexpected(ok.error());
    lines.push_back(in_holder(placed, holder));
  }
  return lines;
}

void CheckStep::declare(ConfigSchema& schema) {
  schema.section("check", "A body of known size, the tracker at rest, and the tracker's field.");
  schema.flag("check.body", tests_.body, "Test the scan of a body; false: the tracker alone.");
  line_.declare(schema, "check");
  schema.choice("check.shape", shape_.shape,
                {{"plane", Shape::plane}, {"cylinder", Shape::cylinder}, {"sphere", Shape::sphere}},
                "What is scanned.");
  schema.number("check.diameter_mm", shape_.diameter_mm, {.unit = "mm", .min = 5, .max = 1000},
                "Of cylinder or sphere, by caliper.");
  schema.integer("check.least_lines", shape_.least_lines, {.min = 10, .max = 100000}, "Laser lines needed.");
  schema.integer("check.most_lines", most_lines_, {.min = 0, .max = 100000},
                 "Enough laser lines; 0: until --seconds are over or the recording ends.");
  schema.integer("check.least_passes", shape_.least_passes, {.min = 1, .max = 1000},
                 "Passes to and fro needed.");
  schema.number("check.least_extent_mm", shape_.least_extent_mm, {.unit = "mm", .min = 1, .max = 1000},
                "Way of the scan that is needed.");
  const NumberSpec limit{.unit = "mm", .min = 0.001, .max = 100};
  schema.number("check.most_bias_mm", shape_.most_bias_mm, limit,
                "Limit of the systematic error of the size.");
  schema.number("check.most_precision_mm", shape_.most_precision_mm, limit, "Limit of the points' SD.");
  schema.number("check.most_repeatability_mm", shape_.most_repeatability_mm, limit,
                "Limit of the passes' SD.");
  schema.number("check.most_target_error_mm", shape_.most_target_error_mm, limit,
                "Limit of the RMS error of points that were in no fit.");
  schema.flag("check.still", tests_.still, "Test the tracker at rest as well.");
  schema.numbers("check.still_stations", still_stations_, {.min = 1, .max = kMaxStations}, {},
                 "Sensors that lie still, numbered as on the tracker; empty: the object's.");
  schema.number("check.still_seconds", still_.least_seconds, {.unit = "s", .min = 0.5, .max = 600},
                "A sensor has to lie still for so long.");
  const NumberSpec small{.unit = "mm", .min = 0.001, .max = 10};
  schema.number("check.most_jitter_mm", still_.most_jitter_mm, small,
                "Limit of a resting sensor's RMS jitter.");
  schema.number("check.most_jitter_deg", still_.most_jitter_deg, {.unit = "deg", .min = 0.001, .max = 10},
                "The same of its attitude.");
  schema.number("check.most_drift_mm", still_.most_drift_mm, small, "Limit of a resting sensor's drift.");
  schema.number("check.most_distortion", still_.most_distortion, {.min = 0, .max = 1e6},
                "Limit of the tracker's metal indicator, where it gives one.");
  declare_pair(schema);
}

void CheckStep::declare_pair(ConfigSchema& schema) {
  schema.numbers("check.metal_pair", tests_.metal_pair, {.min = 1, .max = kMaxStations},
                 {.min_items = 0, .max_items = 2},
                 "Metal test: two sensors that are fixed to each other and carried about, numbered as on the "
                 "tracker; empty: not tested.");
  schema.number("check.metal_spacing_mm", pair_.spacing_mm, {.unit = "mm", .min = 5, .max = 500},
                "Metal test: distance between two places.");
  schema.integer("check.metal_places", pair_.least_places, {.min = 2, .max = 1000},
                 "Metal test: places needed.");
  schema.number("check.most_metal_mm", pair_.most_mm, {.unit = "mm", .min = 0.01, .max = 100},
                "Metal test: limit of the RMS difference of the pair's distance.");
  schema.number("check.most_metal_deg", pair_.most_deg, {.unit = "deg", .min = 0.01, .max = 90},
                "Metal test: limit of the RMS difference of its turn.");
}

Result<void> CheckStep::validate() const {
  if (auto ok = calibrate::validate(shape_); !ok) return ok;
  if (auto ok = calibrate::validate(pair_); !ok) return ok;
  const bool pair_fits = tests_.metal_pair.empty() ||
                         (tests_.metal_pair.size() == 2 && tests_.metal_pair[0] != tests_.metal_pair[1]);
  if (!pair_fits) return fail(ErrorCode::invalid, "check.metal_pair names two different sensors, or none");
  if (!tests_.body && !tests_.still && tests_.metal_pair.empty())
    return fail(ErrorCode::invalid,
                "check.body, check.still and check.metal_pair are all off: nothing to check");
  return calibrate::validate(still_);
}

CollectOptions CheckStep::wants(const BoardOptions&) const {
  CollectOptions wanted;
  if (tests_.body) wanted.line = line_.line;
  wanted.poses_only = !tests_.body;
  wanted.most_pictures = static_cast<std::size_t>(most_lines_);
  return wanted;
}

std::string CheckStep::coverage(const Session& so_far, const BoardOptions&) const {
  return fmt::format("{} of {} pictures with a laser line", so_far.observations.size(), so_far.offered);
}

std::vector<StillStation> CheckStep::resting(const Session& session) const {
  std::vector<int> stations;
  for (const double number : still_stations_) stations.push_back(static_cast<int>(number) - 1);
  if (stations.empty() && session.stations.object >= 0) stations.push_back(session.stations.object);
  if (stations.empty()) {
    for (int station = 0; station < kMaxStations; ++station) stations.push_back(station);
  }
  std::vector<StillStation> stretches;
  for (const int station : stations)
    stretches.push_back(still_stretch(session.poses.at(static_cast<std::size_t>(station)), station));
  return stretches;
}

Result<void> CheckStep::test_body(const Session& session, const Calibration& before, Outcome& outcome) const {
  outcome.method = fmt::format("{} of known size, least squares of distances", linescope::name(shape_.shape));
  const auto lines = placed_lines(session, before, outcome.quality.left_out, line_.line.axis);
  if (!lines) return tl::unexpected(lines.error());
  const auto check = check_shape(*lines, shape_);
  if (!check) return tl::unexpected(check.error());
  add_shape(outcome, *check);
  outcome.plots.push_back(plot_shape(*check, shape_));
  judge(outcome, above_limit(*check, shape_));
  return {};
}

Result<void> CheckStep::test_rest(const Session& session, Outcome& outcome) const {
  const auto stations = check_still(resting(session), still_);
  if (!stations) return tl::unexpected(stations.error());
  add_still(outcome.quality, *stations);
  outcome.plots.push_back(plot_still(*stations, still_));
  judge(outcome, above_limit(*stations, still_));
  return {};
}

Result<void> CheckStep::test_metal(const Session& session, Outcome& outcome) const {
  const auto samples = [&](std::size_t which) -> const std::vector<PoseSample>& {
    return session.poses.at(static_cast<std::size_t>(tests_.metal_pair[which]) - 1);
  };
  const auto check = check_pair(samples(0), samples(1), pair_);
  if (!check) return tl::unexpected(check.error());
  add_pair(outcome.quality, *check);
  outcome.plots.push_back(plot_pair(*check, pair_));
  judge(outcome, above_limit(*check, pair_));
  return {};
}

Result<Outcome> CheckStep::run(const Session& session, const BoardOptions&, const Calibration& before) const {
  Outcome outcome;
  outcome.method = "the tracker alone";
  outcome.quality.offered = session.offered;
  if (tests_.body) {
    outcome.quality.left_out = session.left_out;
    if (auto ok = test_body(session, before, outcome); !ok) return tl::unexpected(ok.error());
  }
  if (tests_.still)
    if (auto ok = test_rest(session, outcome); !ok) return tl::unexpected(ok.error());
  if (!tests_.metal_pair.empty())
    if (auto ok = test_metal(session, outcome); !ok) return tl::unexpected(ok.error());
  return outcome;
}

}  // namespace linescope::calibrate
