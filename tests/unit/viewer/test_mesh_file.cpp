// Meshes through files and back, by formats other programs read.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "tests/support/child_process.hpp"
#include "viewer/scene/mesh_file.hpp"

namespace linescope::testing {
namespace {

/// Four corners of a square, bent; two triangles, one of them filled.
TriangleMesh bent_square() {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {10, 0, 0}, {10, 8, 1.5F}, {0, 8, 0}};
  mesh.normals = {{0, 0, 1}, {0.6F, 0, 0.8F}, {0, 0, 1}, {0, 0, 1}};
  mesh.uncertainty = {0.125F, 0.25F, 0.5F, std::nanf("")};
  mesh.observations = {5, 6, 7, 0};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.origin = {TriangleOrigin::measured, TriangleOrigin::filled};
  return mesh;
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {(std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>()};
}

class MeshFiles : public ::testing::Test {
 protected:
  TemporaryFolder folder_;
};
class MeshFile : public MeshFiles, public ::testing::WithParamInterface<const char*> {};

TEST_P(MeshFile, ComesBackWithPlaceSizeAndFrame) {
  const auto file = folder_.path() / (std::string("mesh") + GetParam());
  const TriangleMesh mesh = bent_square();
  const auto written = write_mesh(mesh, file, "Object");
  ASSERT_TRUE(written) << written.error().message;
  const auto back = read_mesh(file);
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->vertex_count(), 4U);
  ASSERT_EQ(back->triangle_count(), 2U);
  EXPECT_NEAR(back->area(), mesh.area(), 1e-4);
  EXPECT_EQ(back->normals.size(), 4U);
  EXPECT_EQ(back->origin.size(), 2U);
  // Corner by corner and in the same sense of rotation, whatever the order of the vertices.
  for (std::size_t t = 0; t < 2; ++t)
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_LT((back->positions[back->triangles[t][k]] - mesh.positions[mesh.triangles[t][k]]).norm(),
                1e-4F);
  const std::string text = text_of(file);
  EXPECT_NE(text.find("Object"), std::string::npos) << "the frame";
  EXPECT_NE(text.find("mm"), std::string::npos) << "the unit";
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.path()), {}), 1) << "nothing left over";
}
INSTANTIATE_TEST_SUITE_P(Formats, MeshFile, ::testing::Values(".ply", ".vtp", ".stl", ".obj"));

TEST_F(MeshFiles, VtpHoldsEverything) {
  const auto file = folder_.path() / "mesh.vtp";
  const TriangleMesh mesh = bent_square();
  ASSERT_TRUE(write_mesh(mesh, file, "Object"));
  const auto back = read_mesh(file);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->observations, mesh.observations);
  EXPECT_EQ(back->origin, mesh.origin);
  EXPECT_EQ(back->normals, mesh.normals);
  EXPECT_EQ(back->uncertainty[1], 0.25F);
  EXPECT_TRUE(std::isnan(back->uncertainty[3]));
}

TEST_F(MeshFiles, WhatCannotBeReadIsSaidInASentence) {
  const auto message = [&](const char* name, const char* content) {
    const auto file = folder_.path() / name;
    if (content != nullptr) std::ofstream(file) << content;
    const auto read = read_mesh(file);
    return read ? std::string("read") : read.error().message;
  };
  EXPECT_NE(message("absent.ply", nullptr).find("no such file"), std::string::npos);
  EXPECT_NE(message("mesh.doc", "x").find(".ply, .vtp, .stl or .obj"), std::string::npos);
  EXPECT_NE(message("broken.ply", "ply\nformat ascii 1.0\nelement vertex 3\n").find("broken.ply"),
            std::string::npos);
  EXPECT_NE(message("broken.vtp", "<VTKFile").find("broken.vtp"), std::string::npos);
  EXPECT_NE(message("empty.obj", "# nothing\n").find("no triangle"), std::string::npos);
}

// VTK's reader would crash on some of these.
TEST_F(MeshFiles, AFileCutOffAnywhereIsRefusedAndNotFollowed) {
  for (const char* suffix : {".ply", ".vtp", ".stl"}) {
    const auto file = folder_.path() / (std::string("whole") + suffix),
               cut = folder_.path() / (std::string("cut") + suffix);
    ASSERT_TRUE(write_mesh(bent_square(), file, "Object"));
    const std::string text = text_of(file);
    for (std::size_t length = 0; length < text.size() - 1; length += 3) {
      std::ofstream(cut, std::ios::binary) << text.substr(0, length);
      const auto read = read_mesh(cut);
      EXPECT_LE(read ? read->triangle_count() : 0, 2U) << suffix << " " << length;
      EXPECT_FALSE(read && suffix == std::string(".ply")) << length;
    }
  }
}

TEST_F(MeshFiles, WhatCannotBeWrittenIsSaidAndLeavesNothing) {
  const auto refused = write_mesh(bent_square(), folder_.path() / "absent" / "mesh.ply", "Object");
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("cannot be written"), std::string::npos);
  EXPECT_FALSE(write_mesh(bent_square(), folder_.path() / "mesh.dxf", "Object"));
  EXPECT_FALSE(write_mesh({}, folder_.path() / "mesh.ply", "Object"));
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

}  // namespace
}  // namespace linescope::testing
