// linescope-surface: from a recording to a mesh file, without a window.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <map>
#include <optional>
#include <string>

#include "acquire/record/recording.hpp"
#include "common/exit_code.hpp"
#include "common/version.hpp"
#include "tools/evaluate/session_run.hpp"
#include "tools/evaluate/virtual_session.hpp"
#include "viewer/held_line.hpp"
#include "viewer/scene/mesh_file.hpp"

namespace linescope {
namespace {

struct SurfaceCommand {
  std::string recording, mesh;
  MesherOptions options;
};

TriangleMesh mesh_of(const HeldLines& lines, Mesher& mesher) {
  for (const auto& line : lines) mesher.add_line(surface_line(*line));
  return mesher.mesh();
}

void print_counts(const std::string& file, const std::string& frame, const TriangleMesh& mesh,
                  const MesherCounters& counters, const std::optional<HoleCounts>& holes) {
  const std::size_t filled = mesh.filled_count();
  fmt::print("{}: {} triangles, {:.1f} mm^2, frame {}, millimetres\n", file, mesh.triangle_count(),
             mesh.area(), frame);
  if (filled != 0) fmt::print("{} of the triangles fill holes: nobody measured them\n", filled);
  if (holes && holes->filled + holes->left != 0) fmt::print("{}\n", in_words(*holes));
  fmt::print(
      "{} lines with {} points; refused: {} not finite, {} too far, {} too uncertain, {} without room\n",
      counters.lines, counters.points, counters.not_finite, counters.too_far, counters.too_uncertain,
      counters.no_room);
}

Result<void> run(const SurfaceCommand& command) {
  auto mesher = make_mesher(command.options);
  if (!mesher) return tl::unexpected(mesher.error());
  const auto recording = open_recording(command.recording);
  if (!recording) return tl::unexpected(recording.error());
  const StationRoles roles = evaluate::roles_of(recording->info);
  const auto session = evaluate::run_recording(command.recording, roles, evaluate::better_session());
  if (!session) return tl::unexpected(session.error());
  const TriangleMesh mesh = mesh_of(session->lines, **mesher);
  if (mesh.empty())
    return fail(ErrorCode::invalid, fmt::format("{}: {} lines, and no surface in them", command.recording,
                                                session->lines.size()));
  const std::string frame = frame_name(roles.object >= 0 ? HeldIn::object : HeldIn::world);
  if (auto written = write_mesh(mesh, command.mesh, frame); !written) return written;
  print_counts(command.mesh, frame, mesh, (*mesher)->counters(), (*mesher)->holes());
  return {};
}

void add_options(CLI::App& app, SurfaceCommand& command) {
  const std::map<std::string, MeshMethod> methods(kMeshMethodWords.begin(), kMeshMethodWords.end());
  app.add_option("RECORDING", command.recording, "Folder of a recording")->required();
  app.add_option("MESH", command.mesh, "File to write: .vtp (everything), .ply, .stl or .obj")->required();
  app.add_option("--method", command.options.method, "implicit, pmc (the thesis's) or cmc")
      ->transform(CLI::CheckedTransformer(methods))
      ->default_str("implicit");
  app.add_option("--interval", command.options.interval, "Cubic interval t in mm")->capture_default_str();
  app.add_option("--fill-holes", command.options.fill_holes_up_to,
                 "Fills holes with a rim up to so many mm, marked as filled; 0: none")
      ->capture_default_str();
  app.footer(
      "Exit codes: 0 written, 1 refused (one sentence says why), 2 wrong usage.\n"
      "Research software. Not for clinical use.");
}

}  // namespace
}  // namespace linescope

int main(int argc, char** argv) {
  using namespace linescope;
  CLI::App app("Makes a surface out of a recording and writes it to a mesh file.", "linescope-surface");
  app.set_version_flag("--version", std::string("linescope-surface ") + kVersion);
  SurfaceCommand command;
  add_options(app, command);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : exit_status(ExitCode::usage);
  }
  spdlog::set_level(spdlog::level::warn);
  const auto done = run(command);
  if (!done) fmt::print(stderr, "linescope-surface: {}\n", done.error().message);
  return exit_status(done ? ExitCode::ok : ExitCode::failed);
}
