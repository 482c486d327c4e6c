// 640 line points of one picture to points in the world, beside OpenCV's undistortion followed by Eigen.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <random>
#include <vector>

#include "acquire/reconstruct/line_reconstructor.hpp"
#include "tests/bench/laser/way_table.hpp"
#include "tests/bench/one_processor.hpp"

namespace linescope::bench {
namespace {

constexpr int kRepeat = 100;  // calls per timing: one takes a few microseconds

Calibration instrument(ProfileAxis axis) {
  Calibration c = thesis_camera_ii();
  c.camera = {640, 480, 520, 520, 0, 319.5, 239.5, {-0.38, 0.17, 1e-3, -5e-4, -0.03}};
  // Along rows the laser stands beside the camera instead of above it.
  if (axis == ProfileAxis::row) c.laser.normal = {c.laser.normal.y(), 0, c.laser.normal.z()};
  c.endoscope_from_camera = {
      Eigen::Quaterniond(Eigen::AngleAxisd(0.3, Eigen::Vector3d(3, 1, 2).normalized())), {4, 5, -6}};
  return c;
}

ExtractedLine line_of(ProfileAxis axis) {
  ExtractedLine line;
  line.width = 640;
  line.height = 480;
  line.axis = axis;
  std::mt19937 generator(5);
  std::uniform_real_distribution<float> part(0, 1);
  const int n = line.profiles();
  for (int i = 0; i < n; ++i) {
    const double wave = 60 * std::sin(2 * std::numbers::pi * i / n);
    LineSample s;
    s.u = axis == ProfileAxis::column ? static_cast<float>(i)
                                      : static_cast<float>(420 + wave) + part(generator);
    s.v = axis == ProfileAxis::column ? static_cast<float>(150 + wave) + part(generator)
                                      : static_cast<float>(i);
    s.width = 2;
    s.peak = 120;
    s.snr = 30;
    line.samples.push_back(s);
  }
  return line;
}

/// The way of the textbook, in double precision where OpenCV allows it.
class Peer {
 public:
  Peer(const Calibration& c, const Rigid<World, Endoscope>& pose, const ExtractedLine& line)
      : k_((cv::Mat_<double>(3, 3) << c.camera.fx, 0, c.camera.cx, 0, c.camera.fy, c.camera.cy, 0, 0, 1)),
        d_(1, 5, CV_64F),
        plane_(opencv_from_laser_plane(c.laser)),
        world_((pose * c.endoscope_from_camera).isometry()) {
    for (int i = 0; i < 5; ++i) d_.at<double>(i) = c.camera.distortion[static_cast<std::size_t>(i)];
    for (const LineSample& s : line.samples) pixels_.emplace_back(s.u, s.v);
    points.resize(pixels_.size());
  }

  void run() {
    cv::undistortPoints(pixels_, rays_, k_, d_);
    place();
  }

  /// OpenCV stops after five rounds, far from the exact ray at the picture's rim: for comparing results let
  /// it finish.
  void run_to_the_end() {
    const cv::TermCriteria exact(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 200, 1e-14);
    cv::undistortPoints(pixels_, rays_, k_, d_, cv::noArray(), cv::noArray(), exact);
    place();
  }

  std::vector<Eigen::Vector3d> points;

 private:
  void place() {
    for (std::size_t i = 0; i < rays_.size(); ++i) {
      const Eigen::Vector3d ray(rays_[i].x, rays_[i].y, 1);
      points[i] = world_ * (-plane_(3) / plane_.head<3>().dot(ray) * ray);
    }
  }

  cv::Mat k_, d_;
  Eigen::Vector4d plane_;
  Eigen::Isometry3d world_;
  std::vector<cv::Point2d> pixels_, rays_;
};

void triangulation(benchmark::State& state) {
  pin_to_this_processor();
  cv::setNumThreads(1);
  const ProfileAxis axis = state.range(0) == 0 ? ProfileAxis::column : ProfileAxis::row;
  const Calibration calibration = instrument(axis);
  const Rigid<World, Endoscope> pose{
      Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized())), {10, -5, 300}};
  const ExtractedLine line = line_of(axis);
  const LineReconstructor reconstructor = *LineReconstructor::create(calibration, {});
  ReconstructedLine out;
  Peer peer(calibration, pose, line);
  std::vector<Way> ways{
      {"ours: ray table, deviation of each point included",
       [&] {
         for (int i = 0; i < kRepeat; ++i)
           benchmark::DoNotOptimize(reconstructor.reconstruct(line, pose, out));
       }},
      {"cv::undistortPoints + Eigen plane and transform",
       [&] {
         for (int i = 0; i < kRepeat; ++i) peer.run();
       }},
  };
  for (auto _ : state) run_in_turn(ways, 51);
  print_table(fmt::format("{} points, {} calls", line.samples.size(), kRepeat), ways);
  peer.run_to_the_end();
  double worst = 0;
  for (std::size_t i = 0; i < out.points.size(); ++i)
    worst = std::max(worst, (out.points[i].position.cast<double>() - peer.points[i]).cwiseAbs().maxCoeff());
  fmt::print("points {} of {}, largest difference of a coordinate {:.5f} mm\n", out.points.size(),
             line.samples.size(), worst);
  state.counters["T4 peer/ours"] = ratio(ways[1], ways[0]);
  state.counters["T4 difference mm"] = worst;
}
BENCHMARK(triangulation)->ArgName("rows")->Arg(0)->Arg(1)->Iterations(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace linescope::bench
