#include "tools/evaluate/recorded_session.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "acquire/record/recording.hpp"
#include "tools/evaluate/session_run.hpp"
#include "tools/evaluate/surfaces.hpp"
#include "tools/evaluate/virtual_session.hpp"
#include "viewer/held_line.hpp"
#include "viewer/measure/shape_fits.hpp"

namespace linescope::evaluate {
namespace {

constexpr std::string_view kCylinderPrefix = "cylinder-";

struct Judged {
  Session session;
  Points3 points, mesh;
};

Result<Judged> judged(const std::filesystem::path& folder, const StationRoles& roles,
                      const SessionOptions& algorithms, MeshMethod method) {
  auto session = run_recording(folder, roles, algorithms);
  if (!session) return tl::unexpected(session.error());
  Judged j;
  j.session = std::move(*session);
  for (const Eigen::Vector3f& p : positions_of(j.session.lines)) j.points.push_back(p.cast<double>());
  const Surface surface = surface_of(j.session.lines, method);
  for (const Eigen::Vector3f& p : method == kThesisMesh ? surface.grid : surface.mesh.positions)
    j.mesh.push_back(p.cast<double>());
  return j;
}

std::optional<Estimate> single(double value) {
  return estimate({value});
}

template <class Value>
Row both(const std::string& what, const char* unit, const Judged& plain, const Judged& better, Value value,
         int digits = 2) {
  return {what, unit, {}, single(value(plain)), single(value(better)), digits};
}

double wall_deviation(const Points3& points) {
  const auto wall = fitted_wall(points);
  return wall ? wall->deviation : std::nan("");
}

double diameter(const Points3& points) {
  const auto cylinder = fitted_cylinder(points);
  return cylinder ? 2 * cylinder->section.radius : std::nan("");
}

double section_deviation(const Points3& points) {
  const auto cylinder = fitted_cylinder(points);
  return cylinder ? cylinder->section.deviation : std::nan("");
}

void add_shape(const KnownShape& shape, const Judged& plain, const Judged& better, std::vector<Row>& rows) {
  if (shape.kind == KnownShape::Kind::plane) {
    rows.push_back(both("precision: SD about the best plane, points", "mm", plain, better,
                        [](const Judged& j) { return wall_deviation(j.points); }));
    rows.push_back(both("precision: SD about the best plane, mesh data", "mm", plain, better,
                        [](const Judged& j) { return wall_deviation(j.mesh); }));
  }
  if (shape.kind == KnownShape::Kind::cylinder) {
    const double d = shape.diameter_mm;
    rows.push_back(both(fmt::format("bias of the diameter ({:g} mm), points", d), "mm", plain, better,
                        [d](const Judged& j) { return diameter(j.points) - d; }));
    rows.push_back(both("precision: SD about the fitted cylinder, points", "mm", plain, better,
                        [](const Judged& j) { return section_deviation(j.points); }));
    rows.push_back(both(fmt::format("bias of the diameter ({:g} mm), mesh data", d), "mm", plain, better,
                        [d](const Judged& j) { return diameter(j.mesh) - d; }));
  }
}

Table recorded_table(const KnownShape& shape, const Judged& plain, const Judged& better) {
  Table table{"recorded", "Recorded session", {}, {}};
  table.rows.push_back(both(
      "lines", "", plain, better, [](const Judged& j) { return static_cast<double>(j.session.lines.size()); },
      0));
  table.rows.push_back(both(
      "points", "", plain, better, [](const Judged& j) { return static_cast<double>(j.points.size()); }, 0));
  add_shape(shape, plain, better, table.rows);
  for (const CounterValue& counter : better.session.counters)
    if (counter.value > 0) add_note(table, fmt::format("{}: {}", counter.name, counter.value));
  return table;
}

}  // namespace

Result<KnownShape> known_shape(const std::string& name) {
  KnownShape shape;
  if (name.empty()) return shape;
  if (name == "plane") {
    shape.kind = KnownShape::Kind::plane;
    return shape;
  }
  const bool cylinder = name.starts_with(kCylinderPrefix);
  const char* end = name.data() + name.size();
  const auto [stop, error] =
      cylinder ? std::from_chars(name.data() + kCylinderPrefix.size(), end, shape.diameter_mm)
               : std::from_chars_result{name.data(), std::errc::invalid_argument};
  if (error != std::errc{} || stop != end || !(shape.diameter_mm > 0))
    return fail(
        ErrorCode::usage,
        fmt::format("no shape is called '{}': use plane or cylinder-DIAMETER, for example cylinder-49.1",
                    name));
  shape.kind = KnownShape::Kind::cylinder;
  return shape;
}

Result<Report> evaluate_recording(const std::filesystem::path& folder, const KnownShape& shape) {
  auto recording = open_recording(folder);
  if (!recording) return tl::unexpected(recording.error());
  const StationRoles roles = roles_of(recording->info);
  auto plain = judged(folder, roles, thesis_session(), kThesisMesh);
  if (!plain) return tl::unexpected(plain.error());
  auto better = judged(folder, roles, better_session(), kBetterMesh);
  if (!better) return tl::unexpected(better.error());
  if (better->points.empty())
    return fail(ErrorCode::invalid, fmt::format("{}: no laser line of this recording could be placed; "
                                                "linescope-inspect on a replay says why",
                                                folder.string()));
  Report report{"linescope: evaluation of a recorded session", {kRecorded}, {}};
  report.setting.push_back(fmt::format("Recording: {}. Camera: {}. Tracker: {}.", folder.string(),
                                       recording->info.camera, recording->info.tracker));
  report.sections.push_back({recorded_table(shape, *plain, *better), {}});
  return report;
}

}  // namespace linescope::evaluate
