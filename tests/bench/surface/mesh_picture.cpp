#include "tests/bench/surface/mesh_picture.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace linescope::bench {
namespace {

constexpr int kWidth = 420, kHeight = 240;    // of a tile, px
constexpr double kMargin = 14;                // px
constexpr std::size_t kMostWithEdges = 2500;  // triangles; more would be drawn black

/// x to the right, y up, z to the eye.
Eigen::Matrix3d view() {
  return (Eigen::AngleAxisd(-0.9, Eigen::Vector3d::UnitX()) *
          Eigen::AngleAxisd(0.25, Eigen::Vector3d::UnitZ()))
      .toRotationMatrix();
}

struct Frame {
  Eigen::AlignedBox2d box;
  double scale() const {
    const Eigen::Vector2d s = box.sizes();
    return std::min((kWidth - 2 * kMargin) / s.x(), (kHeight - 30 - 2 * kMargin) / s.y());
  }
  cv::Point place(const Eigen::Vector3d& p) const {
    const Eigen::Vector2d q = (p.head<2>() - box.center()) * scale();
    return {static_cast<int>(kWidth / 2 + q.x()), static_cast<int>(kHeight / 2 + 12 - q.y())};
  }
};

Eigen::Vector3d seen(const TriangleMesh& mesh, std::uint32_t vertex) {
  return view() * mesh.positions[vertex].cast<double>();
}

cv::Scalar colour(const Eigen::Vector3d& across, TriangleOrigin origin) {
  const Eigen::Vector3d light = Eigen::Vector3d(-0.4, 0.5, 0.8).normalized();
  const bool back = across.z() < 0;
  const double shade = 60 + 190 * std::abs(across.normalized().dot(light));
  if (origin == TriangleOrigin::filled) return {0.35 * shade, 0.65 * shade, shade};
  return back ? cv::Scalar(0.6 * shade, 0.5 * shade, 0.5 * shade)
              : cv::Scalar(0.75 * shade, 0.9 * shade, 0.9 * shade);
}

void draw(cv::Mat& tile, const TriangleMesh& mesh, const Frame& frame) {
  std::vector<std::size_t> order(mesh.triangle_count());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto depth = [&](std::size_t t) {
    double sum = 0;
    for (const std::uint32_t v : mesh.triangles[t]) sum += seen(mesh, v).z();
    return sum;
  };
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return depth(a) < depth(b); });
  for (const std::size_t t : order) {
    const auto& [a, b, c] = mesh.triangles[t];
    const Eigen::Vector3d p = seen(mesh, a), q = seen(mesh, b), r = seen(mesh, c);
    const std::array<cv::Point, 3> corners{frame.place(p), frame.place(q), frame.place(r)};
    cv::fillConvexPoly(tile, corners, colour((q - p).cross(r - p), mesh.origin[t]));
    if (mesh.triangle_count() < kMostWithEdges)
      cv::polylines(tile, corners, true, {70, 60, 60}, 1, cv::LINE_AA);
  }
}

}  // namespace

Result<void> write_picture(const std::vector<std::vector<PictureTile>>& rows,
                           const std::filesystem::path& file) {
  Frame frame;
  std::size_t columns = 0;
  for (const auto& row : rows) {
    columns = std::max(columns, row.size());
    for (const PictureTile& tile : row)
      for (std::uint32_t v = 0; v < tile.mesh.vertex_count(); ++v)
        frame.box.extend(Eigen::Vector2d(seen(tile.mesh, v).head<2>()));
  }
  cv::Mat picture(kHeight * static_cast<int>(rows.size()), kWidth * static_cast<int>(columns), CV_8UC3,
                  cv::Scalar::all(255));
  for (std::size_t y = 0; y < rows.size(); ++y)
    for (std::size_t x = 0; x < rows[y].size(); ++x) {
      cv::Mat tile = picture({static_cast<int>(x) * kWidth, static_cast<int>(y) * kHeight, kWidth, kHeight});
      draw(tile, rows[y][x].mesh, frame);
      cv::putText(tile, rows[y][x].title, {12, 22}, cv::FONT_HERSHEY_SIMPLEX, 0.5, {0, 0, 0}, 1, cv::LINE_AA);
    }
  if (!cv::imwrite(file.string(), picture))
    return fail(ErrorCode::unreadable, fmt::format("{}: it cannot be written", file.string()));
  return {};
}

}  // namespace linescope::bench
