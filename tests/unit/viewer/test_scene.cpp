// The scene's parts that can be checked without drawing.
#include <gtest/gtest.h>
#include <vtkNew.h>
#include <vtkPropCollection.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkTextActor.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <string>

#include "viewer/scene/cloud_layer.hpp"
#include "viewer/scene/colour_scale.hpp"
#include "viewer/scene/guidance_layer.hpp"
#include "viewer/scene/surface_layer.hpp"
#include "viewer/scene/view_overlay.hpp"
#include "viewer/scene/view_pose.hpp"

namespace linescope {
namespace {

constexpr double kPi = std::numbers::pi;
void nowhere(vtkProp*) {}

std::shared_ptr<const HeldLine> line_of(int points, int number = 0) {
  auto line = std::make_shared<HeldLine>();
  line->seen_from = {0, 0, 50};
  line->time = (1 + number) * kMillisecond;
  for (int i = 0; i < points; ++i)
    line->points.push_back({{static_cast<float>(i), static_cast<float>(number), 0}, 100, 0.1F});
  return line;
}

TEST(ViewPose, PutsTheCameraWhereTheAnglesSay) {
  vtkNew<vtkCamera> camera;
  apply({.azimuth = kPi / 2, .elevation = 0, .roll = 0, .distance = 10, .target = {1, 2, 3}}, *camera);
  const Eigen::Vector3d position(camera->GetPosition());
  EXPECT_NEAR((position - Eigen::Vector3d(1, 12, 3)).norm(), 0, 1e-12);
  const Eigen::Vector3d up(camera->GetViewUp());
  EXPECT_NEAR((up - Eigen::Vector3d::UnitZ()).norm(), 0, 1e-12);
}

TEST(ViewPose, RollTurnsTheCameraSoThatThePictureTurnsTheOtherWay) {
  vtkNew<vtkCamera> camera;
  apply({.azimuth = 0, .elevation = 0, .roll = kPi / 2, .distance = 10}, *camera);  // at +x, looking along -x
  const Eigen::Vector3d up(camera->GetViewUp());
  // Rolled a quarter counter-clockwise z lies to the left on the screen; what is up then is the former right:
  // +y.
  EXPECT_NEAR((up - Eigen::Vector3d::UnitY()).norm(), 0, 1e-12);
}

TEST(ViewPose, SurvivesTheRoundTripThroughACamera) {
  vtkNew<vtkCamera> camera;
  for (const double az : {-3.0, -1.2, 0.0, 0.4, 2.9})
    for (const double el : {-1.5, -0.3, 0.0, 0.8, 1.5})
      for (const double roll : {-2.8, 0.0, 1.1}) {
        apply({.azimuth = az, .elevation = el, .roll = roll, .distance = 55, .target = {4, 5, 6}}, *camera);
        const ViewPose back = view_pose_of(*camera);
        EXPECT_NEAR(back.azimuth, az, 1e-9);
        EXPECT_NEAR(back.elevation, el, 1e-9);
        EXPECT_NEAR(back.roll, roll, 1e-9);
        EXPECT_NEAR(back.distance, 55, 1e-9);
      }
}

TEST(ViewPose, StraightDownTheViewItselfSurvives) {
  vtkNew<vtkCamera> camera, again;
  apply({.azimuth = 0.7, .elevation = kPi / 2, .roll = 0.3, .distance = 20}, *camera);
  apply(view_pose_of(*camera), *again);
  const Eigen::Vector3d up(camera->GetViewUp()), up_again(again->GetViewUp());
  EXPECT_NEAR((up - up_again).norm(), 0, 1e-9);
}

TEST(CloudLayer, DrawsEverythingUpToItsBudget) {
  CloudLayer cloud(nowhere);
  cloud.set_budget(5'000);
  for (int i = 0; i < 10; ++i) cloud.add(*line_of(500, i));
  EXPECT_EQ(cloud.drawn(), 5'000u);
  EXPECT_EQ(cloud.thinning(), 1u);
}

TEST(CloudLayer, ThinsEvenlyBeyondAndSaysSo) {
  CloudLayer cloud(nowhere);
  cloud.set_budget(5'000);
  for (int i = 0; i < 100; ++i) cloud.add(*line_of(500, i));
  EXPECT_EQ(cloud.received(), 50'000u);
  EXPECT_LE(cloud.drawn(), 5'000u);
  EXPECT_GT(cloud.drawn(), 2'400u);
  EXPECT_EQ(cloud.thinning(), 16u);
  // Every line keeps its share, the first as well as the last.
  std::set<float> lines;
  for (const auto& p : cloud.points()) lines.insert(p.y());
  EXPECT_EQ(lines.size(), 100u);
  cloud.clear();
  EXPECT_EQ(cloud.drawn(), 0u);
  EXPECT_EQ(cloud.thinning(), 1u);
}

TEST(CloudLayer, KnowsFromWhichSideItWasSeen) {
  CloudLayer cloud(nowhere);
  cloud.add(*line_of(3));
  EXPECT_GT(cloud.outward().z(), 0.99);
}

TEST(CloudLayer, AsksForAPictureOnlyWhenSomethingChanged) {
  CloudLayer cloud(nowhere);
  cloud.add(*line_of(10));
  EXPECT_TRUE(cloud.refresh());
  EXPECT_FALSE(cloud.refresh());
}

TEST(SurfaceLayer, ShowsTheMeshItWasGiven) {
  std::vector<vtkProp*> props;
  SurfaceLayer layer([&](vtkProp* p) { props.push_back(p); });
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh->normals.assign(4, {0, 0, 1});
  mesh->uncertainty.assign(4, 0.1F);
  mesh->observations.assign(4, 5);
  mesh->triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh->origin.assign(2, TriangleOrigin::measured);
  SurfaceView view;
  view.mesh = mesh;
  view.grid = std::make_shared<std::vector<Eigen::Vector3f>>(3, Eigen::Vector3f(1, 2, 3));
  layer.set(view);
  layer.refresh();
  EXPECT_EQ(layer.triangles(), 2u);
  EXPECT_EQ(layer.grid_points(), 3u);
  auto* surface = vtkActor::SafeDownCast(props[0]);
  ASSERT_NE(surface, nullptr);
  auto* data = vtkPolyData::SafeDownCast(surface->GetMapper()->GetInput());
  ASSERT_NE(data, nullptr);
  EXPECT_EQ(data->GetNumberOfPolys(), 2);
  vtkNew<vtkIdList> corners;
  data->GetCellPoints(1, corners);
  EXPECT_EQ(corners->GetId(2), 3);
}

TEST(SurfaceLayer, WhatClosesAHoleIsDrawnInAColourOfItsOwn) {
  std::vector<vtkProp*> props;
  SurfaceLayer layer([&](vtkProp* p) { props.push_back(p); });
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh->normals.assign(4, {0, 0, 1});
  mesh->uncertainty.assign(4, 0.1F);
  mesh->observations.assign(4, 5);
  mesh->triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh->origin = {TriangleOrigin::measured, TriangleOrigin::filled};
  SurfaceView view;
  view.mesh = mesh;
  layer.set(view);
  layer.refresh();
  EXPECT_EQ(layer.triangles(), 2u);
  EXPECT_EQ(layer.filled_triangles(), 1u);
  auto* measured = vtkActor::SafeDownCast(props[0]);
  auto* filled = vtkActor::SafeDownCast(props[1]);
  ASSERT_TRUE(measured != nullptr && filled != nullptr);
  EXPECT_EQ(vtkPolyData::SafeDownCast(measured->GetMapper()->GetInput())->GetNumberOfPolys(), 1);
  EXPECT_EQ(vtkPolyData::SafeDownCast(filled->GetMapper()->GetInput())->GetNumberOfPolys(), 1);
  const double *a = measured->GetProperty()->GetColor(), *b = filled->GetProperty()->GetColor();
  EXPECT_GT(std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]), 0.3);
  layer.show(SurfaceStyle::hidden);
  EXPECT_FALSE(filled->GetVisibility());
}

TEST(GuidanceLayer, GhostsAndHides) {
  GuidanceLayer layer(nowhere, nowhere);
  GuidanceInput input;
  layer.set(input);
  EXPECT_FALSE(layer.harvester_visible());
  EXPECT_FALSE(layer.normal_visible());
  input.harvester = Presence::present;
  input.normal = true;
  layer.set(input);
  EXPECT_TRUE(layer.harvester_visible());
  EXPECT_FALSE(layer.harvester_ghosted());
  EXPECT_TRUE(layer.normal_visible());
  input.harvester = Presence::ghost;
  input.normal = false;
  layer.set(input);
  EXPECT_TRUE(layer.harvester_ghosted());
  EXPECT_FALSE(layer.normal_visible());
}

TEST(GuidanceLayer, PutsTheTipWhereItIs) {
  std::vector<vtkProp*> props;
  GuidanceLayer layer([&](vtkProp* p) { props.push_back(p); }, nowhere);
  GuidanceInput input;
  input.harvester = Presence::present;
  input.tip = {10, 20, 30};
  input.axis = Eigen::Vector3d(1, 1, 1).normalized();
  layer.set(input);
  const double* centre = vtkActor::SafeDownCast(props[0])->GetCenter();
  EXPECT_NEAR((Eigen::Vector3d(centre) - input.tip).norm(), 0, 1e-4);
}

TEST(ColourScale, RangeLeavesOutliersAndMissingValuesOut) {
  std::vector<float> values(1000);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i);
  values[3] = 1e9F;
  values[4] = std::numeric_limits<float>::quiet_NaN();
  const auto [low, high] = colour_range(values);
  EXPECT_NEAR(low, 20, 3);
  EXPECT_NEAR(high, 980, 3);
}

TEST(ColourScale, BrightnessOnlyRises) {
  const auto table = colour_scale();
  const auto brightness = [&](vtkIdType i) {
    const double* c = table->GetTableValue(i);
    return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
  };
  // The table has 8 bits per colour, so neighbours may be equal; some colours further on they may not.
  for (vtkIdType i = 1; i < table->GetNumberOfTableValues(); ++i)
    EXPECT_GE(brightness(i), brightness(i - 1)) << i;
  for (vtkIdType i = 4; i < table->GetNumberOfTableValues(); ++i)
    EXPECT_GT(brightness(i), brightness(i - 4)) << i;
}

/// Where the overlay puts its title, from the left and from the top.
std::array<double, 2> place_of_title(int dpi, double scale) {
  vtkNew<vtkRenderWindow> window;
  vtkNew<vtkRenderer> renderer;
  window->OffScreenRenderingOn();
  window->AddRenderer(renderer);
  window->SetSize(800, 600);
  window->SetDPI(dpi);
  ViewOverlay overlay(*renderer);
  overlay.set_title("the title");
  overlay.set_scale(scale);
  overlay.update();
  vtkPropCollection& props = *renderer->GetViewProps();
  for (int i = 0; i < props.GetNumberOfItems(); ++i) {
    auto* text = vtkTextActor::SafeDownCast(props.GetItemAsObject(i));
    if (text == nullptr || text->GetInput() == nullptr || text->GetInput() != std::string("the title"))
      continue;
    return {text->GetPosition()[0], 600 - text->GetPosition()[1]};
  }
  ADD_FAILURE() << "no title";
  return {};
}

/// 72 dots per inch are VTK's word for a screen without scaling.
TEST(ViewOverlay, KeepsItsDistancesOnAScreenOfManyPixels) {
  const auto usual = place_of_title(72, 1), fine = place_of_title(144, 1), large = place_of_title(72, 1.5);
  EXPECT_GT(usual[0], 5);
  EXPECT_GT(usual[1], 5);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(fine[i], 2 * usual[i], 1) << i;
    EXPECT_NEAR(large[i], 1.5 * usual[i], 1) << i;
  }
}

TEST(ScaleBar, LengthsAreRound) {
  EXPECT_DOUBLE_EQ(round_length(9.99), 5);
  EXPECT_DOUBLE_EQ(round_length(10.01), 10);
  EXPECT_DOUBLE_EQ(round_length(0.3), 0.2);
  EXPECT_DOUBLE_EQ(round_length(1.5), 1);
}

}  // namespace
}  // namespace linescope
