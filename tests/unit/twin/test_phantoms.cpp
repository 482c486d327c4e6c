// Phantoms: hits lie on the surface, distances are distances, meshes agree with the bodies they approximate.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "acquire/twin/dice.hpp"
#include "acquire/twin/ellipsoid.hpp"
#include "acquire/twin/phantom.hpp"
#include "acquire/twin/triangle_phantom.hpp"
#include "twin_shapes.hpp"

namespace linescope::twin {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;

std::shared_ptr<const Phantom> phantom(const char* name) {
  return *make_phantom(*phantom_from_name(name));
}

class EveryPhantom : public testing::TestWithParam<const char*> {};

TEST_P(EveryPhantom, RaysFromAboveHitTheSurfaceAndItsNormalFacesThem) {
  const auto body = phantom(GetParam());
  Dice dice(3, Stream::texture);
  int hits = 0;
  for (int i = 0; i < 300; ++i) {
    const Vector3d from(dice.uniform(-6, 6), dice.uniform(-4, 4), dice.uniform(5, 20));
    const Vector3d to(dice.uniform(-3, 3), dice.uniform(-3, 3), 0);
    const Vector3d way = (to - from).normalized();
    Hit hit;
    if (!body->cast(from, way, hit)) continue;
    ++hits;
    const Vector3d point = from + hit.distance * way;
    EXPECT_NEAR(body->distance(point), 0, 1e-9);
    EXPECT_LT(hit.normal.dot(way), 1e-9);
    EXPECT_NEAR(hit.normal.norm(), 1, 1e-12);
    EXPECT_NEAR((body->normal(point + 1e-6 * hit.normal) - hit.normal).norm(), 0, 1e-3);
  }
  EXPECT_GT(hits, 280);
}

// All but the mini knee, whose middle is the groove between two bumps.
class SmoothPhantom : public testing::TestWithParam<const char*> {};

TEST_P(SmoothPhantom, SiteMiddleIsTheOriginAndFacesUp) {
  const auto body = phantom(GetParam());
  EXPECT_NEAR(body->distance({0, 0, 0}), 0, 1e-9);
  EXPECT_NEAR((body->normal({0, 0, 1}) - Vector3d::UnitZ()).norm(), 0, 1e-9);
  EXPECT_NEAR(body->distance({0, 0, 2}), 2, 1e-9);
  EXPECT_NEAR(body->distance({0, 0, -2}), -2, 1e-9);
}

std::string test_name(const testing::TestParamInfo<const char*>& instance) {
  std::string text = instance.param;
  for (char& c : text) {
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  }
  return text;
}

INSTANTIATE_TEST_SUITE_P(All, EveryPhantom,
                         testing::Values("condyle", "plane", "cylinder-49", "cylinder-49.1", "cylinder-50",
                                         "mini-knee"),
                         test_name);
INSTANTIATE_TEST_SUITE_P(All, SmoothPhantom, testing::Values("condyle", "plane", "cylinder-49.1"), test_name);

// The smallest distance to a dense set of surface points bounds the true one from above, and comes close.
TEST(Ellipsoid, DistanceAgreesWithDenseSampling) {
  const Ellipsoid body({25, 22, 15}, {0, 0, -15});
  Dice dice(5, Stream::texture);
  for (int i = 0; i < 20; ++i) {
    const Vector3d point(dice.uniform(-40, 40), dice.uniform(-40, 40), dice.uniform(-50, 30));
    double nearest = 1e9;
    for (int a = 0; a < 400; ++a) {
      for (int b = 0; b <= 200; ++b) {
        const double azimuth = a * std::numbers::pi / 200, polar = b * std::numbers::pi / 200;
        const Vector3d surface(25 * std::sin(polar) * std::cos(azimuth),
                               22 * std::sin(polar) * std::sin(azimuth), 15 * std::cos(polar) - 15);
        nearest = std::min(nearest, (point - surface).norm());
      }
    }
    const double stated = std::abs(body.distance(point));
    EXPECT_LE(stated, nearest + 1e-9);
    // Samples are at most 0.28 mm from the foot; the error is that squared over twice the distance, or 0.28
    // close by.
    EXPECT_GE(stated, nearest - std::min(0.28, 0.28 * 0.28 / (2 * std::max(0.1, nearest)) * 3));
  }
}

TEST(MiniKnee, MeasuresNineBySixByTwo) {
  const auto body = phantom("mini-knee");
  const auto height = [&](double x, double y) {
    Hit hit;
    EXPECT_TRUE(body->cast({x, y, 50}, {0, 0, -1}, hit));
    return 50 - hit.distance;
  };
  EXPECT_NEAR(height(0, 2.1), 0, 1e-9);
  EXPECT_NEAR(height(0, -2.1), 0, 1e-9);
  EXPECT_NEAR(height(20, 20), -2, 1e-9) << "the plate lies 2 mm below the bumps";
  EXPECT_GT(height(2.95, 2.1), -2) << "6 mm along the sweep";
  EXPECT_NEAR(height(3.05, 2.1), -2, 1e-9);
  EXPECT_GT(height(0, 4.45), -2) << "9 mm across";
  EXPECT_NEAR(height(0, 4.55), -2, 1e-9);
}

TEST(PhantomNames, ReadBackAndRefuse) {
  for (const char* text : {"condyle", "plane", "cylinder-49.1", "mini-knee"}) {
    EXPECT_EQ(name(*phantom_from_name(text)), text);
  }
  for (const char* text : {"knee", "cylinder-", "cylinder-x", "cylinder-50mm", ""}) {
    const auto none = phantom_from_name(text);
    ASSERT_FALSE(none) << text;
    EXPECT_THAT(none.error().message, HasSubstr("condyle, plane"));
  }
  EXPECT_THAT(phantom_from_name("cylinder-0.05").error().message, HasSubstr("5 to 1000 mm"));
}

TEST(TriangleMesh, SphereOfTrianglesAgreesWithTheSphere) {
  const auto mesh = make_triangle_phantom(sphere_of_triangles(20.0, 6));
  ASSERT_TRUE(mesh) << mesh.error().message;
  const Ellipsoid sphere({20, 20, 20}, {0, 0, -20});
  Dice dice(9, Stream::texture);
  for (int i = 0; i < 200; ++i) {
    const Vector3d from(dice.uniform(-8, 8), dice.uniform(-8, 8), 15);
    const Vector3d way = (Vector3d(dice.uniform(-5, 5), dice.uniform(-5, 5), -5) - from).normalized();
    Hit on_mesh, on_sphere;
    ASSERT_TRUE((*mesh)->cast(from, way, on_mesh));
    ASSERT_TRUE(sphere.cast(from, way, on_sphere));
    // Largest facets: half diagonal 0.44 mm, so they lie up to 0.44^2 / (2 * 20) = 0.005 mm below the sphere.
    EXPECT_NEAR(on_mesh.distance, on_sphere.distance, 0.01);
    EXPECT_NEAR((*mesh)->distance(from), sphere.distance(from), 0.01);
    EXPECT_GT(on_mesh.normal.dot(on_sphere.normal), 0.999);
  }
  EXPECT_NEAR((*mesh)->distance({0, 0, -15}), -15, 0.02);
}

TEST(TriangleMesh, TreeFindsWhatAllTrianglesTogetherFind) {
  const TriangleSoup soup = sphere_of_triangles(10.0, 3);
  const TriangleTree tree(soup);
  Dice dice(11, Stream::texture);
  for (int i = 0; i < 200; ++i) {
    const Vector3d from = 25 * dice.direction();
    const Vector3d way = (6 * dice.direction() - from).normalized();
    const auto hit = tree.cast(from, way);
    EXPECT_NEAR(hit ? hit->distance : -1, nearest_hit_by_search(soup, from, way), 1e-9);
  }
}

TEST(TriangleMesh, InsideOutMeshIsTurned) {
  TriangleSoup soup = sphere_of_triangles(20.0, 2);
  for (auto& t : soup.triangles) std::swap(t[0], t[1]);
  const auto mesh = make_triangle_phantom(soup);
  ASSERT_TRUE(mesh);
  EXPECT_GT((*mesh)->normal({0, 0, 1}).z(), 0.9);
  EXPECT_GT((*mesh)->distance({0, 0, 5}), 0);
}

TEST(TriangleMesh, BadMeshesAreRefusedInOneSentence) {
  const auto message = [](const TriangleSoup& soup) { return make_triangle_phantom(soup).error().message; };
  EXPECT_THAT(message({}), HasSubstr("empty"));

  TriangleSoup open = sphere_of_triangles(20.0, 2);
  open.triangles.pop_back();
  EXPECT_THAT(message(open), HasSubstr("not closed: 3 edges"));

  const TriangleSoup metres = sphere_of_triangles(0.02, 2);
  EXPECT_THAT(message(metres), HasSubstr("metres"));
  EXPECT_THAT(message(metres), HasSubstr("0.04 x 0.04 x 0.04"));

  EXPECT_THAT(message(sphere_of_triangles(20000, 2)), HasSubstr("too large"));

  TriangleSoup stray = sphere_of_triangles(20.0, 1);
  stray.triangles[3][1] = 100000;
  EXPECT_THAT(message(stray), HasSubstr("triangle 3"));

  TriangleSoup nan = sphere_of_triangles(20.0, 1);
  nan.points[5].y() = std::nan("");
  EXPECT_THAT(message(nan), HasSubstr("point 5"));
}

}  // namespace
}  // namespace linescope::twin
