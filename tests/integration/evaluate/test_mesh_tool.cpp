// linescope-mesh: every kind of file, and one sentence for every mesh that is no body.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <fstream>

#include "acquire/twin/phantom.hpp"
#include "acquire/twin/triangle_file.hpp"
#include "tests/support/child_process.hpp"
#include "tests/support/finished_run.hpp"

namespace linescope {
namespace {

using testing::Finished;
using ::testing::HasSubstr;
using testing::run_to_end;
using testing::TemporaryFolder;
using Corner = std::array<double, 3>;

const std::array<Corner, 8> kCorners{
    {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};
// Quads, counter-clockwise from outside.
const std::array<std::array<int, 4>, 6> kSides{
    {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};

/// A box of that edge length; `sides` of its six.
std::string as_stl(double edge, std::size_t sides = 6) {
  std::string text = "solid box\n";
  for (std::size_t s = 0; s < sides; ++s) {
    for (const auto& pick : {std::array{0, 1, 2}, std::array{0, 2, 3}}) {
      text += "facet normal 0 0 0\nouter loop\n";
      for (const int k : pick) {
        const Corner& c = kCorners[static_cast<std::size_t>(kSides[s][static_cast<std::size_t>(k)])];
        text += fmt::format("vertex {} {} {}\n", c[0] * edge, c[1] * edge, c[2] * edge);
      }
      text += "endloop\nendfacet\n";
    }
  }
  return text + "endsolid box\n";
}

std::string as_obj(double edge) {
  std::string text;
  for (const Corner& c : kCorners) text += fmt::format("v {} {} {}\n", c[0] * edge, c[1] * edge, c[2] * edge);
  for (const auto& s : kSides) text += fmt::format("f {} {} {} {}\n", s[0] + 1, s[1] + 1, s[2] + 1, s[3] + 1);
  return text;
}

std::string as_ply(double edge) {
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 6\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Corner& c : kCorners) text += fmt::format("{} {} {}\n", c[0] * edge, c[1] * edge, c[2] * edge);
  for (const auto& s : kSides) text += fmt::format("4 {} {} {} {}\n", s[0], s[1], s[2], s[3]);
  return text;
}

std::string as_vtp(double edge) {
  std::string points, corners, ends;
  for (const Corner& c : kCorners) points += fmt::format("{} {} {} ", c[0] * edge, c[1] * edge, c[2] * edge);
  for (std::size_t i = 0; i < kSides.size(); ++i) {
    corners += fmt::format("{} ", fmt::join(kSides[i], " "));
    ends += fmt::format("{} ", 4 * (i + 1));
  }
  return fmt::format(
      "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\"><PolyData><Piece "
      "NumberOfPoints=\"8\" "
      "NumberOfPolys=\"6\"><Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" "
      "format=\"ascii\">{}</DataArray>"
      "</Points><Polys><DataArray type=\"Int64\" Name=\"connectivity\" "
      "format=\"ascii\">{}</DataArray><DataArray "
      "type=\"Int64\" Name=\"offsets\" "
      "format=\"ascii\">{}</DataArray></Polys></Piece></PolyData></VTKFile>\n",
      points, corners, ends);
}

class MeshTool : public ::testing::Test {
 protected:
  Finished convert(const std::string& name, const std::string& text, std::vector<std::string> more = {}) {
    const auto file = folder_.path() / name;
    std::ofstream(file) << text;
    std::vector<std::string> arguments{LINESCOPE_MESH, file.string(), target()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_to_end(std::move(arguments), std::chrono::seconds(60));
  }
  std::string target() const { return (folder_.path() / "phantom.off").string(); }

 private:
  TemporaryFolder folder_;
};

TEST_F(MeshTool, EveryKindOfFileBecomesAPhantomOfTheTwin) {
  const std::array<std::pair<const char*, std::string>, 4> files{
      {{"box.stl", as_stl(20)}, {"box.obj", as_obj(20)}, {"BOX.PLY", as_ply(20)}, {"box.vtp", as_vtp(20)}}};
  for (const auto& [name, text] : files) {
    const Finished o = convert(name, text);
    ASSERT_EQ(o.code, 0) << name << ": " << o.err;
    EXPECT_THAT(o.out, HasSubstr("8 points, 12 triangles, 20.0 x 20.0 x 20.0 mm")) << name;
    const auto options = twin::phantom_from_name(target());
    ASSERT_TRUE(options) << options.error().message;
    const auto phantom = twin::make_phantom(*options);
    ASSERT_TRUE(phantom) << phantom.error().message;
    // A corner of the top is the origin: half way down the middle of the box is 10 mm deep.
    EXPECT_EQ(options->mesh.points.size(), 8u);
    EXPECT_NEAR(std::abs((*phantom)->distance({0, 0, 5})), 5, 1e-9);
  }
}

TEST_F(MeshTool, OpenMeshIsRefusedWithItsNumberOfEdges) {
  const Finished o = convert("open.stl", as_stl(20, 5));
  EXPECT_EQ(o.code, 1);
  EXPECT_THAT(o.err, HasSubstr("not closed: 4 edges"));
}

TEST_F(MeshTool, MetresAreRefusedAndScaledWhenAsked) {
  const Finished o = convert("metres.obj", as_obj(0.02));
  EXPECT_EQ(o.code, 1);
  EXPECT_THAT(o.err, HasSubstr("looks like metres"));
  EXPECT_THAT(o.err, HasSubstr("--scale 1000"));
  EXPECT_EQ(convert("metres.obj", as_obj(0.02), {"--scale", "1000"}).code, 0);
}

TEST_F(MeshTool, EmptyBrokenAndUnknownFilesAreRefusedInOneSentence) {
  const Finished empty = convert("empty.stl", "solid nothing\nendsolid nothing\n");
  EXPECT_EQ(empty.code, 1);
  EXPECT_THAT(empty.err, HasSubstr("empty"));
  const Finished broken = convert("broken.vtp", "<VTKFile type=\"PolyData\"><Poly");
  EXPECT_EQ(broken.code, 1);
  EXPECT_EQ(std::count(broken.err.begin(), broken.err.end(), '\n'), 1) << broken.err;
  const Finished unknown = convert("box.step", "ISO-10303-21;");
  EXPECT_EQ(unknown.code, 1);
  EXPECT_THAT(unknown.err, HasSubstr(".ply, .vtp, .stl or .obj"));
}

}  // namespace
}  // namespace linescope
