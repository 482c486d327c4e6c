// Pivot recordings made by others, with the places of the divots that they print.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <fstream>
#include <sstream>

#include "tests/support/shared_data.hpp"
#include "tools/calibrate/pivot_fit.hpp"

namespace linescope::calibrate {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

struct Table {
  std::vector<int> counts;  ///< of the heading
  std::vector<Vector3d> rows;
  Matrix3Xd part(std::size_t first, int count) const {
    Matrix3Xd points(3, count);
    for (int i = 0; i < count; ++i) points.col(i) = rows[first + static_cast<std::size_t>(i)];
    return points;
  }
};

Table read_table(const char* name) {
  std::ifstream file(linescope::testing::shared_data(std::string("pivot/pa1-debug-a-") + name));
  Table table;
  std::string line;
  std::getline(file, line);
  std::istringstream heading(line);
  for (int count = 0; heading >> count; heading.ignore(1)) table.counts.push_back(count);
  while (std::getline(file, line)) {
    std::istringstream text(line);
    Vector3d row;
    char comma = 0;
    if (text >> row.x() >> comma >> row.y() >> comma >> row.z()) table.rows.push_back(row);
  }
  return table;
}

Eigen::Isometry3d registered(const Matrix3Xd& from, const Matrix3Xd& to) {
  return Eigen::Isometry3d(Eigen::umeyama(from, to, false));
}

Rigid<Fixture, Harvester> as_pose(const Eigen::Isometry3d& t) {
  return {Eigen::Quaterniond(t.linear()), t.translation()};
}

// Too few and too coarse (two decimals) for a calibration, enough to compare with what is printed.
Vector3d divot_of(const ToolPoses& poses) {
  const auto fit = fit_pivot(poses, {.least_poses = 10});
  EXPECT_TRUE(fit) << fit.error().message;
  return fit ? fit->divot : Vector3d::Zero();
}

TEST(PivotReal, ElectromagneticDivotIsWhereItIsPrinted) {
  LINESCOPE_NEEDS_SHARED_DATA();
  const Table table = read_table("empivot.txt"), expected = read_table("output1.txt");
  const int markers = table.counts.at(0), frames = table.counts.at(1);
  const Matrix3Xd first = table.part(0, markers);
  const Matrix3Xd tool = first.colwise() - first.rowwise().mean();
  ToolPoses poses;
  for (int k = 0; k < frames; ++k) {
    const auto at = static_cast<std::size_t>(k * markers);
    poses.push_back({k * kSecond, as_pose(registered(tool, table.part(at, markers)))});
  }
  EXPECT_LT((divot_of(poses) - expected.rows.at(0)).norm(), 0.04);
}

TEST(PivotReal, OpticalDivotIsWhereItIsPrinted) {
  LINESCOPE_NEEDS_SHARED_DATA();
  const Table table = read_table("optpivot.txt"), body = read_table("calbody.txt"),
              expected = read_table("output1.txt");
  const int base = table.counts.at(0), markers = table.counts.at(1), frames = table.counts.at(2);
  const Matrix3Xd base_markers = body.part(0, base);
  ToolPoses poses;
  Matrix3Xd tool;
  for (int k = 0; k < frames; ++k) {
    const auto at = static_cast<std::size_t>(k * (base + markers));
    const auto camera_from_base = registered(base_markers, table.part(at, base));
    const Matrix3Xd seen =
        camera_from_base.inverse() * table.part(at + static_cast<std::size_t>(base), markers);
    if (k == 0) tool = seen.colwise() - seen.rowwise().mean();
    poses.push_back({k * kSecond, as_pose(registered(tool, seen))});
  }
  EXPECT_LT((divot_of(poses) - expected.rows.at(1)).norm(), 0.04);
}

}  // namespace
}  // namespace linescope::calibrate
