// linescope-surface: a recorded scan of a sphere becomes a mesh file that says its frame and unit and has the
// sphere's radius.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <fstream>
#include <sstream>

#include "tests/support/child_process.hpp"
#include "tests/support/finished_run.hpp"

namespace linescope {
namespace {

using ::testing::ContainsRegex;
using testing::file_contents;
using testing::Finished;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::run_to_end;
using testing::TemporaryFolder;

std::vector<Eigen::Vector3d> vertices_of_obj(const std::string& file) {
  std::vector<Eigen::Vector3d> vertices;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string kind;
    Eigen::Vector3d p;
    if (words >> kind >> p.x() >> p.y() >> p.z() && kind == "v") vertices.push_back(p);
  }
  return vertices;
}

/// Of the sphere nearest to the points: |p|^2 = 2 c p + (r^2 - |c|^2) is linear in c and the rest.
double sphere_radius(const std::vector<Eigen::Vector3d>& points) {
  Eigen::MatrixX4d left(points.size(), 4);
  Eigen::VectorXd right(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    left.row(row) << 2 * points[i].transpose(), 1;
    right[row] = points[i].squaredNorm();
  }
  const Eigen::Vector4d k = left.colPivHouseholderQr().solve(right);
  return std::sqrt(k[3] + k.head<3>().squaredNorm());
}

class SurfaceTool : public ::testing::Test {
 protected:
  void SetUp() override {
    const Finished recorded =
        run_to_end({LINESCOPE_ACQUIRE, "--segment", testing::unique_segment(), "--fast", "--scan",
                    "--exit-at-end", "--record", recording(), "--set", "twin.phantom=sphere-50", "--set",
                    "twin.scenario=sweeps", "--set", "twin.noise=ideal", "--set", "twin.duration_s=2.5"});
    ASSERT_EQ(recorded.code, 0) << recorded.err;
  }
  std::string recording() const { return path("session"); }
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  Finished surface(const std::string& mesh, std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments{LINESCOPE_SURFACE, recording(), path(mesh)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_to_end(std::move(arguments));
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(SurfaceTool, MakesFilesThatSayFrameAndUnitAndHoldTheSphere) {
  for (const char* name : {"mesh.obj", "mesh.ply", "mesh.stl", "mesh.vtp"}) {
    const Finished o = surface(name);
    ASSERT_EQ(o.code, 0) << name << ": " << o.err;
    EXPECT_THAT(o.out, HasSubstr("frame Object, millimetres")) << name;
    EXPECT_THAT(file_contents(path(name)), HasSubstr("frame")) << name;
    EXPECT_THAT(file_contents(path(name)), HasSubstr("unit")) << name;
  }
  const auto vertices = vertices_of_obj(path("mesh.obj"));
  ASSERT_GT(vertices.size(), 100u);
  EXPECT_NEAR(sphere_radius(vertices), 25, 0.1);  // a cap of some 25 x 10 mm, no noise
}

TEST_F(SurfaceTool, MethodAndIntervalAreTheUsers) {
  ASSERT_EQ(surface("one.obj").code, 0);
  ASSERT_EQ(surface("pmc.obj", {"--method", "pmc"}).code, 0);
  ASSERT_EQ(surface("coarse.obj", {"--interval", "2.54"}).code, 0);
  const auto count = [&](const char* name) { return vertices_of_obj(path(name)).size(); };
  EXPECT_GT(count("pmc.obj"), 3 * count("one.obj") / 2);  // a skin on both sides
  EXPECT_LT(count("coarse.obj"), count("one.obj") / 2);
}

TEST_F(SurfaceTool, SaysWhichHolesAreClosedAndWhyOthersStayOpen) {
  const Finished none = surface("none.obj", {"--interval", "0.5"}),
                 some = surface("some.obj", {"--interval", "0.5", "--fill-holes", "3"});
  ASSERT_EQ(none.code, 0) << none.err;
  EXPECT_THAT(none.out, Not(HasSubstr("hole")));
  ASSERT_EQ(some.code, 0) << some.err;
  EXPECT_THAT(some.out,
              ContainsRegex("[1-9][0-9]* holes? closed, [1-9][0-9]* open: [1-9][0-9]* with too long a rim"));
  EXPECT_THAT(some.out, HasSubstr("fill holes: nobody measured them"));
}

TEST_F(SurfaceTool, RefusesInOneSentence) {
  const Finished suffix = surface("mesh.doc"), interval = surface("mesh.ply", {"--interval", "0"});
  EXPECT_EQ(suffix.code, 1);
  EXPECT_THAT(suffix.err, HasSubstr(".ply, .vtp, .stl or .obj"));
  EXPECT_EQ(interval.code, 1);
  EXPECT_THAT(interval.err, HasSubstr("must be a positive number of mm"));
  EXPECT_EQ(surface("mesh.ply", {"--method", "magic"}).code, 2);
  const Finished missing = run_to_end({LINESCOPE_SURFACE, "/no/such/recording", path("mesh.ply")});
  EXPECT_EQ(missing.code, 1);
  EXPECT_THAT(missing.err, HasSubstr("/no/such/recording"));
}

}  // namespace
}  // namespace linescope
