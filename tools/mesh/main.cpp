// linescope-mesh: makes a phantom of the digital twin out of a mesh file.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>

#include "acquire/twin/triangle_file.hpp"
#include "acquire/twin/triangle_phantom.hpp"
#include "common/exit_code.hpp"
#include "common/version.hpp"
#include "viewer/scene/mesh_file.hpp"

namespace linescope {
namespace {

struct MeshCommand {
  std::string in, out;
  double scale = 1;
};

twin::TriangleSoup soup_of(const TriangleMesh& mesh, double scale) {
  twin::TriangleSoup soup;
  for (const Eigen::Vector3f& p : mesh.positions) soup.points.emplace_back(p.cast<double>() * scale);
  for (const auto& t : mesh.triangles)
    soup.triangles.push_back({static_cast<int>(t[0]), static_cast<int>(t[1]), static_cast<int>(t[2])});
  return soup;
}

ExitCode refuse(const std::string& message) {
  fmt::print(stderr, "linescope-mesh: {}\n", message);
  return ExitCode::failed;
}

ExitCode run(const MeshCommand& command) {
  const auto mesh = read_mesh(command.in, Corners::merged);
  if (!mesh) return refuse(mesh.error().message);
  const twin::TriangleSoup soup = soup_of(*mesh, command.scale);
  if (auto valid = validate(soup); !valid) {
    const bool unit = valid.error().message.find("looks like metres") != std::string::npos;
    return refuse(fmt::format("{}: {}{}", command.in, valid.error().message, unit ? " (--scale 1000)" : ""));
  }
  std::ofstream out(command.out);
  out << triangles_text(soup);
  out.close();
  if (!out) return refuse(fmt::format("{}: it cannot be written", command.out));
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : soup.points) box.extend(p);
  fmt::print("{}: {} points, {} triangles, {:.1f} x {:.1f} x {:.1f} mm\n", command.out, soup.points.size(),
             soup.triangles.size(), box.sizes().x(), box.sizes().y(), box.sizes().z());
  return ExitCode::ok;
}

}  // namespace
}  // namespace linescope

int main(int argc, char** argv) {
  CLI::App app("Makes a phantom of the digital twin out of a mesh file (STL, PLY, OBJ, VTP).",
               "linescope-mesh");
  linescope::MeshCommand command;
  app.set_version_flag("--version", std::string("linescope-mesh ") + linescope::kVersion);
  app.add_option("MESH", command.in,
                 "Closed surface in millimetres; its highest point along z becomes the site")
      ->required();
  app.add_option("PHANTOM", command.out, "File to write; must end in .off")
      ->required()
      ->check([](const std::string& name) {
        return std::string(name.ends_with(linescope::twin::kTriangleFileSuffix) ? "" : "must end in .off");
      });
  app.add_option("--scale", command.scale, "Multiplies every coordinate: 1000 for a mesh in metres")
      ->check(CLI::Range(1e-6, 1e6));
  app.footer(
      "Use it with linescope-acquire --set twin.phantom=PHANTOM.\n"
      "Exit codes: 0 written, 1 refused (one sentence says why), 2 wrong usage.\n"
      "Research software. Not for clinical use.");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : linescope::exit_status(linescope::ExitCode::usage);
  }
  return linescope::exit_status(linescope::run(command));
}
