// What is kept of a scan, and whether it comes back.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/child_process.hpp"
#include "viewer/scene/mesh_file.hpp"
#include "viewer/session/points_file.hpp"
#include "viewer/session/session.hpp"

namespace linescope::testing {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

std::shared_ptr<const HeldLine> line_of(std::uint64_t serial, int points) {
  auto line = std::make_shared<HeldLine>();
  line->serial = serial;
  line->time = 123'456'789'012'345 + static_cast<Nanoseconds>(serial);
  line->seen_from = {1.5, -2.25, 80};
  for (int i = 0; i < points; ++i)
    line->points.push_back(
        {{0.1F * static_cast<float>(i), static_cast<float>(serial), -3.125F}, 200.0F, 0.0625F});
  return line;
}

Session session() {
  Session s;
  s.saved = "2024-05-06T07:08:09";
  s.program = "linescope-viewer 9.9";
  s.daemon = "some daemon";
  // Two lines of the same number: the scan of a daemon that was restarted.
  s.lines = {line_of(1, 3), line_of(2, 5), line_of(1, 4)};
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.normals.assign(3, {0, 0, 1});
  mesh.triangles = {{0, 1, 2}};
  mesh.origin = {TriangleOrigin::measured};
  s.mesh = std::make_shared<const TriangleMesh>(mesh);
  s.mesher.method = MeshMethod::implicit;
  s.mesher.interval = 0.635;
  s.method = "One-sided surface (implicit)";
  ShapeEvaluation e;
  e.shape = Shape::cylinder;
  e.points = 12;
  e.diameter = 49.21;
  e.nominal = 49;
  e.deviation = 0.12;
  s.evaluations = {e};
  s.distances = {12.34};
  s.configuration = "[camera]\nname = \"<twin>\"\n";
  s.calibration = "camera: yes\n";
  s.diagnostics = "all is well\n";
  return s;
}

std::string text_of(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

class SessionFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    std::ofstream(folder_.path() / "scan.png") << "a picture";
    kept_ = folder_.path() / "kept";
  }
  Result<void> save() { return save_session(session(), kept_, {folder_.path() / "scan.png"}, control_); }
  std::string refusal() {
    const auto loaded = load_session(kept_, control_);
    return loaded ? std::string("loaded") : loaded.error().message;
  }

  TemporaryFolder folder_;
  fs::path kept_;
  JobControl control_;
};

TEST_F(SessionFiles, ComeBackAsTheyWere) {
  const auto saved = save();
  ASSERT_TRUE(saved) << saved.error().message;
  const Session before = session();
  for (const fs::path& path : {kept_, kept_ / "session.toml"}) {
    const auto after = load_session(path, control_);
    ASSERT_TRUE(after) << after.error().message;
    EXPECT_EQ(after->name, "kept");
    EXPECT_EQ(after->saved, before.saved);
    EXPECT_EQ(after->daemon, before.daemon);
    EXPECT_EQ(after->held_in, HeldIn::object);
    EXPECT_EQ(after->mesher.method, MeshMethod::implicit);
    EXPECT_EQ(after->mesher.interval, 0.635);
    ASSERT_EQ(after->lines.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
      const HeldLine &a = *before.lines[i], &b = *after->lines[i];
      EXPECT_EQ(b.time, a.time);
      EXPECT_EQ(b.seen_from, a.seen_from);
      ASSERT_EQ(b.points.size(), a.points.size());
      for (std::size_t k = 0; k < a.points.size(); ++k) {
        EXPECT_LT((b.points[k].position - a.points[k].position).norm(), 1e-4F);
        EXPECT_EQ(b.points[k].intensity, a.points[k].intensity);
        EXPECT_NEAR(b.points[k].standard_deviation, a.points[k].standard_deviation, 1e-4F);
      }
    }
    ASSERT_TRUE(after->mesh);
    EXPECT_EQ(after->mesh->triangle_count(), 1U);
  }
}

TEST_F(SessionFiles, HoldEverythingThatIsPromised) {
  ASSERT_TRUE(save());
  for (const char* file : {"session.toml", "surface.ply", "points.csv", "lines.csv", "evaluation.csv",
                           "configuration.toml", "calibration.yaml", "diagnostics.txt", "report.html"})
    EXPECT_TRUE(fs::is_regular_file(kept_ / file)) << file;
  EXPECT_EQ(text_of(kept_ / "pictures" / "scan.png"), "a picture");
  EXPECT_EQ(text_of(kept_ / "configuration.toml"), session().configuration);
  EXPECT_EQ(text_of(kept_ / "calibration.yaml"), session().calibration);
  EXPECT_EQ(text_of(kept_ / "diagnostics.txt"), "all is well\n");
  EXPECT_THAT(text_of(kept_ / "evaluation.csv"), HasSubstr("cylinder,12,"));
  EXPECT_THAT(text_of(kept_ / "evaluation.csv"), HasSubstr("49.2100,49.0000,0.2100"));
  const std::string report = text_of(kept_ / "report.html");
  EXPECT_THAT(report, HasSubstr("Not for clinical use"));
  EXPECT_THAT(report, HasSubstr("pictures/scan.png"));
  EXPECT_THAT(report, HasSubstr("49.210"));
  EXPECT_THAT(report, HasSubstr("12.34 mm"));
  EXPECT_THAT(report, HasSubstr("12 in 3 lines"));
  EXPECT_THAT(report, HasSubstr("&lt;twin&gt;")) << "what others wrote is text, not markup";
  EXPECT_THAT(text_of(kept_ / "session.toml"), HasSubstr("not for clinical use"));
}

TEST_F(SessionFiles, AreNeverWrittenOverAnother) {
  ASSERT_TRUE(save());
  const auto again = save();
  ASSERT_FALSE(again);
  EXPECT_THAT(again.error().message, HasSubstr("there already"));
}

TEST_F(SessionFiles, AreWholeOrNotThere) {
  control_.cancel();
  const auto given_up = save();
  ASSERT_FALSE(given_up);
  EXPECT_EQ(given_up.error().code, ErrorCode::gone);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), {}), 1) << "only the picture";
  JobControl other;
  const auto nowhere = save_session(session(), "/proc/nowhere/kept", {}, other);
  ASSERT_FALSE(nowhere);
  EXPECT_THAT(nowhere.error().message, HasSubstr("/proc/nowhere/kept"));
}

TEST_F(SessionFiles, ThatAreDamagedAreRefusedWithFileAndLine) {
  EXPECT_THAT(refusal(), HasSubstr("no such file"));
  fs::create_directory(kept_);
  EXPECT_THAT(refusal(), HasSubstr("no saved session"));
  fs::remove(kept_);
  ASSERT_TRUE(save());
  const auto with = [&](const char* file, const std::string& text) {
    const std::string was = text_of(kept_ / file);
    std::ofstream(kept_ / file) << text;
    const std::string said = refusal();
    std::ofstream(kept_ / file) << was;
    return said;
  };
  const std::string points = text_of(kept_ / "points.csv"), lines = text_of(kept_ / "lines.csv");
  EXPECT_THAT(with("points.csv", points + "1,2,3\n"), HasSubstr("points.csv, line 14: six numbers"));
  EXPECT_THAT(with("points.csv", points + "9,0,0,0,0,0\n"), HasSubstr("not in lines.csv"));
  EXPECT_THAT(with("points.csv", points + "1,nan,0,0,0,0\n"), HasSubstr("not a finite number"));
  EXPECT_THAT(with("points.csv", "x,y\n"), HasSubstr("points.csv, line 1"));
  EXPECT_THAT(with("lines.csv", lines + "4,x\n"), HasSubstr("lines.csv, line 5: five numbers"));
  EXPECT_THAT(with("session.toml", "format = 2\n"), HasSubstr("format 2"));
  EXPECT_THAT(with("session.toml", "format = \n"), HasSubstr("session.toml, line 1"));
  EXPECT_THAT(with("surface.ply", "ply\n"), HasSubstr("surface.ply"));
  EXPECT_EQ(refusal(), "loaded");
}

TEST_F(SessionFiles, OrAMeshAloneWithoutPoints) {
  const auto file = folder_.path() / "bone.stl";
  ASSERT_TRUE(write_mesh(*session().mesh, file, "Object"));
  const auto loaded = load_session(file, control_);
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_EQ(loaded->name, "bone.stl");
  EXPECT_EQ(loaded->mesh->triangle_count(), 1U);
  EXPECT_EQ(loaded->point_count(), 0U);
}

}  // namespace
}  // namespace linescope::testing
