// Real pictures and poses of a real scanner through the real daemon, read back from the segment and compared
// with the board that was scanned (reference: an independent calibration, see calibration.yaml of the
// recording).
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <opencv2/core.hpp>

#include "tests/integration/acquire/daemon_under_test.hpp"
#include "tests/support/shared_data.hpp"

namespace linescope::testing {
namespace {

struct Board {
  Eigen::Vector3d origin, normal;
  double distance(const Eigen::Vector3f& p) const { return normal.dot(p.cast<double>() - origin); }
};

Board read_board() {
  const cv::FileStorage file(shared_data("miniature-scanner/calibration.yaml").string(),
                             cv::FileStorage::READ);
  cv::Mat m;
  file["base_from_board"] >> m;
  return {{m.at<double>(0, 3), m.at<double>(1, 3), m.at<double>(2, 3)},
          {m.at<double>(0, 2), m.at<double>(1, 2), m.at<double>(2, 2)}};
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

TEST(MiniatureScanner, PointsFromTheSegmentLieOnTheBoard) {
  LINESCOPE_NEEDS_SHARED_DATA();
  DaemonUnderTest daemon({"--camera", shared_data("miniature-scanner/frames"), "--tracker",
                          shared_data("miniature-scanner/poses.csv"), "--calibration",
                          shared_data("miniature-scanner/calibration.yaml"), "--set", "laser.colour=red",
                          "--scan", "--fast"});
  auto reader = daemon.attach();
  ASSERT_TRUE(reader) << daemon.process().standard_error();
  ASSERT_TRUE(eventually([&] { return counter(*reader, Counter::frames_received) == 19; }));
  ASSERT_TRUE(eventually([&] { return counter(*reader, Counter::lines_published) == 19; }))
      << "lines: " << counter(*reader, Counter::lines_published);
  const LineBatch scan = whole_scan(*reader);
  ASSERT_EQ(scan.lines.size(), 19u);

  const Board board = read_board();
  int good = 0;
  for (const Line& line : scan.lines) {
    std::vector<double> distances;
    for (const SurfacePoint& p : scan.points_of(line)) distances.push_back(board.distance(p.position));
    EXPECT_GE(distances.size(), 200u) << "picture " << line.frame;
    const double middle = median(distances);
    std::printf("picture %2d: %4zu points, median %+.3f mm\n", static_cast<int>(line.frame), distances.size(),
                middle);
    EXPECT_LE(std::abs(middle), 1.6) << "picture " << line.frame;
    good += std::abs(middle) <= 0.35 ? 1 : 0;
  }
  EXPECT_GE(good, 12);
}

TEST(MiniatureScanner, TwoRunsGiveTheSamePoints) {
  LINESCOPE_NEEDS_SHARED_DATA();
  const auto scan = [] {
    DaemonUnderTest daemon({"--camera", shared_data("miniature-scanner/frames"), "--tracker",
                            shared_data("miniature-scanner/poses.csv"), "--calibration",
                            shared_data("miniature-scanner/calibration.yaml"), "--set", "laser.colour=red",
                            "--scan", "--fast"});
    auto reader = daemon.attach();
    if (!reader) return std::vector<Eigen::Vector3f>{};
    eventually([&] { return counter(*reader, Counter::lines_published) == 19; });
    std::vector<Eigen::Vector3f> positions;
    for (const SurfacePoint& p : whole_scan(*reader).points) positions.push_back(p.position);
    return positions;
  };
  const auto first = scan();
  EXPECT_GT(first.size(), 19u * 200u);
  EXPECT_EQ(first, scan());
}

}  // namespace
}  // namespace linescope::testing
