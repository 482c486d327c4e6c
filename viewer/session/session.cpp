#include "viewer/session/session.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <fstream>

#include "common/version.hpp"
#include "viewer/scene/mesh_file.hpp"
#include "viewer/session/points_file.hpp"

namespace linescope {
namespace {

namespace fs = std::filesystem;

constexpr int kFormat = 1;
// How long the parts take, as shares of the whole.
constexpr std::pair<double, double> kPointsShare{0.0, 0.8};

Result<void> write_text(const fs::path& file, const std::string& text) {
  std::ofstream out(file, std::ios::binary);
  out << text;
  return flushed(out, file);
}

const char* method_word(MeshMethod method) {
  for (const auto& [word, one] : kMeshMethodWords)
    if (one == method) return word;
  return "?";
}

std::string heading(const Session& s) {
  std::ostringstream out;
  out << "# A scan kept by linescope-viewer. Research software, not for clinical use.\n"
      << toml::table{{"format", kFormat},
                     {"saved", s.saved},
                     {"program", s.program},
                     {"daemon", s.daemon},
                     {"frame", frame_name(s.held_in)},
                     {"unit", "mm"},
                     {"lines", static_cast<std::int64_t>(s.lines.size())},
                     {"points", static_cast<std::int64_t>(s.point_count())},
                     {"mesh", toml::table{{"method", method_word(s.mesher.method)},
                                          {"made_by", s.method},
                                          {"interval_mm", s.mesher.interval}}}}
      << '\n';
  return out.str();
}

std::string evaluation_rows(const Session& s) {
  std::string text =
      "shape,points,region_radius_mm,mean_mm,mean_size_mm,sd_mm,maximum_mm,diameter_mm,nominal_mm,difference_"
      "mm\n";
  for (const ShapeEvaluation& e : s.evaluations)
    text += fmt::format("{},{},{},{:.4f},{:.4f},{:.4f},{:.4f},{},{},{}\n", name(e.shape), e.points,
                        e.region.all ? std::string() : fmt::format("{:.2f}", e.region.radius), e.mean,
                        e.mean_size, e.deviation, e.maximum,
                        e.has_diameter() ? fmt::format("{:.4f}", e.diameter) : "",
                        e.has_difference() ? fmt::format("{:.4f}", e.nominal) : "",
                        e.has_difference() ? fmt::format("{:.4f}", e.difference()) : "");
  for (const double d : s.distances) text += fmt::format("distance,,,,,,,{:.4f},,\n", d);
  return text;
}

Result<void> write_all(const Session& s, const fs::path& folder, const std::vector<fs::path>& pictures,
                       JobControl& control) {
  if (auto ok = write_points(s.lines, folder, control, kPointsShare); !ok) return ok;
  if (s.mesh && !s.mesh->empty())
    if (auto ok = write_mesh(*s.mesh, folder / "surface.ply", frame_name(s.held_in)); !ok) return ok;
  if (!control.go_on(0.95)) return given_up();
  std::error_code error;
  std::vector<std::string> names;
  fs::create_directory(folder / "pictures", error);
  for (const fs::path& picture : pictures) {
    fs::copy_file(picture, folder / "pictures" / picture.filename(), error);
    if (!error) names.push_back(picture.filename().string());
  }
  const std::pair<const char*, std::string> texts[] = {{"session.toml", heading(s)},
                                                       {"evaluation.csv", evaluation_rows(s)},
                                                       {"configuration.toml", s.configuration},
                                                       {"calibration.yaml", s.calibration},
                                                       {"diagnostics.txt", s.diagnostics},
                                                       {"report.html", session_report(s, names)}};
  for (const auto& [file, text] : texts)
    if (auto ok = write_text(folder / file, text); !ok) return ok;
  return {};
}

Result<toml::table> parsed(const fs::path& file) {
  try {
    return toml::parse_file(file.string());
  } catch (const toml::parse_error& error) {
    return fail(ErrorCode::unreadable,
                fmt::format("{}, line {}: {}", file.string(), error.source().begin.line,
                            std::string(error.description())));
  }
}

Result<void> read_heading(const fs::path& file, Session& s) {
  const auto heading = parsed(file);
  if (!heading) return tl::unexpected(heading.error());
  const toml::table& t = *heading;
  const auto format = t["format"].value_or(std::int64_t{0});
  if (format != kFormat)
    return fail(ErrorCode::unsupported, fmt::format("{}: sessions of format {} are not known to this version",
                                                    file.string(), format));
  s.saved = t["saved"].value_or(std::string());
  s.program = t["program"].value_or(std::string());
  s.daemon = t["daemon"].value_or(std::string());
  s.held_in = t["frame"].value_or(std::string()) == "World" ? HeldIn::world : HeldIn::object;
  s.method = t["mesh"]["made_by"].value_or(std::string());
  const std::string method = t["mesh"]["method"].value_or(std::string("pmc"));
  for (const auto& [word, one] : kMeshMethodWords)
    if (method == word) s.mesher.method = one;
  s.mesher.interval = t["mesh"]["interval_mm"].value_or(s.mesher.interval);
  return validate(s.mesher);
}

Result<void> read_surface(const fs::path& file, Session& s) {
  auto mesh = read_mesh(file);
  if (!mesh) return tl::unexpected(mesh.error());
  s.mesh = std::make_shared<const TriangleMesh>(std::move(*mesh));
  return {};
}

Result<Session> load_folder(const fs::path& folder, JobControl& control) {
  Session s;
  s.name = folder.filename().string();
  if (auto ok = read_heading(folder / "session.toml", s); !ok) return tl::unexpected(ok.error());
  auto lines = read_points(folder, control, {0.0, 0.9});
  if (!lines) return tl::unexpected(lines.error());
  s.lines = std::move(*lines);
  std::error_code error;
  if (fs::exists(folder / "surface.ply", error))
    if (auto ok = read_surface(folder / "surface.ply", s); !ok) return tl::unexpected(ok.error());
  return s;
}

}  // namespace

std::size_t Session::point_count() const {
  std::size_t sum = 0;
  for (const auto& line : lines) sum += line->points.size();
  return sum;
}

Result<void> save_session(const Session& session, const fs::path& folder,
                          const std::vector<fs::path>& pictures, JobControl& control) {
  std::error_code error;
  if (fs::exists(folder, error))
    return fail(ErrorCode::permission,
                folder.string() + " is there already: choose another name for the session");
  const fs::path part = folder.string() + ".part";
  fs::remove_all(part, error);
  if (!fs::create_directories(part, error))
    return fail(ErrorCode::permission,
                folder.string() + " cannot be made: is its place there and writable (--sessions DIR)?");
  Result<void> done = write_all(session, part, pictures, control);
  if (done) {
    fs::rename(part, folder, error);
    if (error) done = fail(ErrorCode::permission, folder.string() + " cannot be made: " + error.message());
  }
  if (!done) fs::remove_all(part, error);
  return done;
}

Result<Session> load_session(const fs::path& path, JobControl& control) {
  std::error_code error;
  if (path.filename() == "session.toml") return load_folder(path.parent_path(), control);
  if (fs::is_directory(path, error)) {
    if (!fs::exists(path / "session.toml", error))
      return fail(ErrorCode::not_found,
                  path.string() + " is no saved session: there is no session.toml in it");
    return load_folder(path, control);
  }
  Session s;
  s.name = path.filename().string();
  s.method = "read from a file";
  if (auto ok = read_surface(path, s); !ok) return tl::unexpected(ok.error());
  return s;
}

}  // namespace linescope
