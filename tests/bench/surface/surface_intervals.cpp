// The four intervals of the thesis's Fig 4.8 on the same points: holes, detail, time, accuracy, and a
// picture.
//
//   surface_intervals                      the donor site, sigma 0.26 mm
//   surface_intervals --scan FILE          points of a file (surface_scan writes them)
//   surface_intervals --picture FILE.png   also draws what the table is about
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>

#include "tests/bench/surface/file_scan.hpp"
#include "tests/bench/surface/mesh_picture.hpp"
#include "tests/unit/surface/mesh_topology.hpp"

namespace linescope::bench {
namespace {

using testing::CondyleScan;

constexpr std::array kIntervals{5.08, 2.54, 1.27, 0.635};  // mm, as in the figure
constexpr double kRippleLength = 6, kRippleHeight = 0.5;   // mm

struct Method {
  const char* name;
  MeshMethod method;
};
constexpr std::array kMethods{Method{"PMC", MeshMethod::proposed_cubes},
                              Method{"one-sided", MeshMethod::implicit}};

struct TimedMesh {
  TriangleMesh mesh;
  double seconds = 0;  // median
};

TimedMesh timed_mesh(const CondyleScan& scan, MeshMethod method, double interval) {
  const auto mesher = std::move(*make_mesher({.method = method, .interval = interval}));
  TimedMesh result;
  std::array<double, 7> seconds{};
  for (double& one : seconds) {
    const auto begin = std::chrono::steady_clock::now();
    mesher->clear();
    testing::add_all(*mesher, scan.lines);
    mesher->write_mesh(result.mesh);
    one = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  }
  std::nth_element(seconds.begin(), seconds.begin() + 3, seconds.end());
  result.seconds = seconds[3];
  return result;
}

/// Ways through a closed skin, or borders of an open surface beyond the outer one of every piece.
long holes(const testing::MeshTopology& topology) {
  const long pieces = static_cast<long>(topology.pieces);
  return topology.closed() ? pieces - topology.euler() / 2 : pieces - topology.euler();
}

CondyleScan with_ripple(CondyleScan scan) {
  for (auto& line : scan.lines)
    for (auto& p : line.points)
      p.position.z() +=
          static_cast<float>(kRippleHeight * std::sin(2 * std::numbers::pi * p.position.x() / kRippleLength));
  return scan;
}

/// Share of the ripple's height that the upper side of the mesh still has.
double ripple_kept(const TriangleMesh& mesh, const CondyleScan& scan) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i) {
    const Eigen::Vector3d p = mesh.positions[i].cast<double>();
    if (mesh.normals[i].z() < 0.3f || scan.beyond_border(mesh.positions[i]) > -1.27) continue;
    const double phase = 2 * std::numbers::pi * p.x() / kRippleLength;
    const Eigen::Vector3d row(1, std::sin(phase), std::cos(phase));
    normal += row * row.transpose();
    right += row * (p.z() - scan.truth.height(p.x(), p.y()));
  }
  const Eigen::Vector3d fitted = normal.completeOrthogonalDecomposition().solve(right);
  return fitted.y() / kRippleHeight;
}

void print_row(const Method& method, double interval, const TimedMesh& result, const CondyleScan& scan) {
  const auto topology = testing::topology_of(result.mesh);
  const auto accuracy = testing::accuracy_of(result.mesh, scan, 1.27);
  const TriangleMesh rippled = timed_mesh(with_ripple(scan), method.method, interval).mesh;
  fmt::print("| {} | {} | {} | {} | {} | {:.3f} | {:.3f} | {:.0f} % | {:.2f} |\n", method.name, interval,
             result.mesh.triangle_count(), topology.pieces, holes(topology),
             testing::rms_of_all(result.mesh, scan, 1.27), accuracy.mean, 100 * ripple_kept(rippled, scan),
             1e3 * result.seconds);
}

std::vector<std::vector<PictureTile>> study(const CondyleScan& scan) {
  fmt::print(
      "{} points\n| method | t mm | triangles | pieces | holes | RMS mm | mean mm (within 1 mm) | ripple "
      "kept | ms |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n",
      scan.point_count());
  std::vector<std::vector<PictureTile>> pictures;
  for (const Method& method : kMethods) {
    auto& row = pictures.emplace_back();
    for (const double interval : kIntervals) {
      const TimedMesh result = timed_mesh(scan, method.method, interval);
      print_row(method, interval, result, scan);
      row.push_back({fmt::format("{}, t = {} mm", method.name, interval), result.mesh});
    }
  }
  return pictures;
}

std::string option(int argc, char** argv, std::string_view name) {
  for (int i = 1; i + 1 < argc; ++i)
    if (argv[i] == name) return argv[i + 1];
  return {};
}

int run(int argc, char** argv) {
  const std::string file = option(argc, argv, "--scan"), picture = option(argc, argv, "--picture");
  auto scan = file.empty() ? Result<CondyleScan>(testing::scan_condyle()) : scan_from_file(file);
  if (!scan) return fmt::print(stderr, "surface_intervals: {}\n", scan.error().message), 1;
  const auto pictures = study(*scan);
  if (picture.empty()) return 0;
  const auto written = write_picture(pictures, picture);
  if (!written) fmt::print(stderr, "surface_intervals: {}\n", written.error().message);
  return written ? 0 : 1;
}

}  // namespace
}  // namespace linescope::bench

int main(int argc, char** argv) {
  return linescope::bench::run(argc, argv);
}
