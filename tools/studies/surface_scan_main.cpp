// surface_scan: one scan of the condyle by the digital twin, through the daemon's own chain, into a file that
// the surface's benchmark and interval study read (docs/surface.md).
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <cstdio>

#include "tools/evaluate/setups.hpp"
#include "tools/evaluate/virtual_session.hpp"
#include "tools/studies/surface_scan_file.hpp"

namespace linescope::study {
namespace {

struct ScanCommand {
  std::string file, preset = "thesis";
  double seconds = 5;
  std::uint64_t seed = 1;
};

/// In the frame of the ellipsoid's centre.
ScanFile scan_file(const HeldLines& lines, const Rigid<twin::PhantomFrame, Object>& phantom_from_object,
                   const Eigen::Vector3d& axes) {
  ScanFile scan;
  scan.axes = axes;
  const Eigen::Vector3d top(0, 0, axes.z());
  const auto placed = [&](const Eigen::Vector3d& p) -> Eigen::Vector3d {
    return phantom_from_object * p + top;
  };
  for (const auto& held : lines) {
    ScanFileLine line{held->time, placed(held->seen_from), held->points};
    for (SurfacePoint& p : line.points) p.position = placed(p.position.cast<double>()).cast<float>();
    scan.lines.push_back(std::move(line));
  }
  scan.seen = seen_extent(scan.lines);
  return scan;
}

Result<void> run(const ScanCommand& command) {
  twin::TwinOptions options = evaluate::sweeping_freely(evaluate::system_ii(command.seed), command.seconds);
  options.phantom = evaluate::phantom("condyle");
  if (auto known = twin::apply_noise_preset(options, command.preset); !known) return known;
  const auto session = evaluate::VirtualSession::render(options);
  if (!session) return tl::unexpected(session.error());
  const auto scan = session->acquire(evaluate::better_session());
  if (!scan) return tl::unexpected(scan.error());
  const ScanFile file =
      scan_file(scan->lines, session->phantom_from_object(), options.phantom.condyle_semi_axes_mm);
  fmt::print("{}: {} lines, {} points, {:.1f} x {:.1f} mm\n", command.file, file.lines.size(), scan->points(),
             file.seen.x(), file.seen.y());
  return write_scan(file, command.file);
}

int main_with(int argc, char** argv) {
  CLI::App app{"Scans the twin's condyle and writes the points, with the truth, to a text file."};
  ScanCommand command;
  app.add_option("FILE", command.file, "text file to write")->required();
  app.add_option("--seconds", command.seconds, "of scanning; 30 lines each")
      ->check(CLI::Range(0.5, 600.0))
      ->capture_default_str();
  app.add_option("--seed", command.seed, "of the experiment")->capture_default_str();
  app.add_option("--noise", command.preset, "noise preset of the twin")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  spdlog::set_level(spdlog::level::warn);
  const auto done = run(command);
  if (!done) fmt::print(stderr, "surface_scan: {}\n", done.error().message);
  return done ? 0 : 1;
}

}  // namespace
}  // namespace linescope::study

int main(int argc, char** argv) {
  return linescope::study::main_with(argc, argv);
}
