// Lengths that somebody measured by other means, from the extracted middles alone.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <opencv2/core.hpp>

#include "tests/unit/laser/real_pictures.hpp"

namespace linescope {
namespace {

using testing::files_in;
using testing::median;
using testing::middles;

/// The line on the bed, row by row, from the run over the empty bed.
std::vector<double> line_on_empty_bed(LineExtractor& extractor) {
  std::vector<std::vector<double>> rows(480);
  for (const auto& file : files_in("carriage-cube/empty")) {
    const std::vector<double> u = middles(extractor, file);
    for (std::size_t v = 0; v < rows.size(); ++v)
      if (!std::isnan(u[v])) rows[v].push_back(u[v]);
  }
  std::vector<double> bed;
  for (const auto& row : rows) bed.push_back(median(row));
  return bed;
}

TEST(CarriageCube, HeightIsThatOfTheCaliper) {
  LINESCOPE_NEEDS_SHARED_DATA();
  // Red line in the dark, the cube on a carriage; the geometry is the recording's own: camera 80 mm above the
  // bed, laser 37.3 mm beside it, 10.628 px per mm on the bed.
  constexpr double kCaliper = 20.10;
  constexpr double kRaised = 40;      // px; a row that much aside is not on the bed
  constexpr std::size_t kRows = 200;  // of the cube's 270
  LineExtractor extractor(testing::along_rows(LaserColour::red));
  const std::vector<double> bed = line_on_empty_bed(extractor);
  std::vector<double> heights;
  for (const auto& file : files_in("carriage-cube/scan")) {
    const std::vector<double> u = middles(extractor, file);
    std::vector<double> shifts;
    for (std::size_t v = 0; v < u.size(); ++v)
      if (std::abs(bed[v] - u[v]) > kRaised) shifts.push_back(bed[v] - u[v]);
    if (shifts.size() < kRows) continue;
    const double s = median(shifts) / 10.628;
    heights.push_back(80 * s / (37.3 + s));
  }
  ASSERT_GE(heights.size(), 20U);
  // The first and the last picture show the cube's edges.
  for (std::size_t i = 1; i + 1 < heights.size(); ++i)
    EXPECT_NEAR(heights[i], kCaliper, 0.5) << "picture " << i << " of the cube";
  RecordProperty("height", std::to_string(median(heights)));
  EXPECT_NEAR(median(heights), kCaliper, 0.5);
}

/// z = a / (u - u0) + c through all pairs, least squares in z.
struct InverseDepth {
  double a = 0, u0 = 0, c = 0;
  double z(double u) const { return a / (u - u0) + c; }
};

InverseDepth fitted(const std::vector<cv::Point2d>& uz) {
  const auto n = static_cast<Eigen::Index>(uz.size());
  Eigen::MatrixXd m(n, 3);
  Eigen::VectorXd r(n);
  // (u - u0)(z - c) = a is linear in u0, c and a - u0 c.
  for (Eigen::Index i = 0; i < n; ++i) {
    const cv::Point2d& p = uz[static_cast<std::size_t>(i)];
    m.row(i) << p.y, p.x, 1;
    r(i) = p.x * p.y;
  }
  Eigen::Vector3d x = m.colPivHouseholderQr().solve(r);
  InverseDepth f{x(2) + x(0) * x(1), x(0), x(1)};
  for (int round = 0; round < 20; ++round) {
    for (Eigen::Index i = 0; i < n; ++i) {
      const cv::Point2d& p = uz[static_cast<std::size_t>(i)];
      const double d = p.x - f.u0;
      m.row(i) << 1 / d, f.a / (d * d), 1;
      r(i) = p.y - f.z(p.x);
    }
    x = m.colPivHouseholderQr().solve(r);
    f = {f.a + x(0), f.u0 + x(1), f.c + x(2)};
  }
  return f;
}

TEST(HandheldDistance, AllTenAreRecoveredByTheThreeParameterFit) {
  LINESCOPE_NEEDS_SHARED_DATA();
  LineExtractor extractor(testing::along_rows(LaserColour::red));
  std::vector<cv::Point2d> uz;
  for (const auto& file : files_in("handheld/distance")) {
    // dist_01_26cm.png
    const double z = std::stod(file.stem().string().substr(8));
    const std::vector<double> u = middles(extractor, file);
    std::vector<double> around_the_axis;
    for (std::size_t v = 200; v < 280; ++v)
      if (!std::isnan(u[v])) around_the_axis.push_back(u[v]);
    EXPECT_GE(around_the_axis.size(), 60U) << file.filename();
    uz.emplace_back(median(around_the_axis), z);
  }
  ASSERT_EQ(uz.size(), 10U);
  const InverseDepth fit = fitted(uz);
  double worst = 0;
  for (const cv::Point2d& p : uz) {
    EXPECT_NEAR(fit.z(p.x), p.y, 0.3) << "cm, line at " << p.x << " px";
    worst = std::max(worst, std::abs(fit.z(p.x) - p.y));
  }
  RecordProperty("worst_cm", std::to_string(worst));
}

}  // namespace
}  // namespace linescope
