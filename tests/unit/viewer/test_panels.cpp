// Every box, list and button of the panels, worked with mouse and keys as Qt delivers them.
#include <gtest/gtest.h>

#include <QApplication>
#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QProgressBar>
#include <QPushButton>
#include <QtTest>

#include "common/units.hpp"
#include "viewer/panel/banner_bar.hpp"
#include "viewer/panel/navigate_page.hpp"
#include "viewer/panel/surface_page.hpp"
#include "viewer/panel/top_bar.hpp"
#include "viewer/panel/view_strip.hpp"

namespace linescope {
namespace {

class Panels : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    qputenv("QT_QPA_PLATFORM", "offscreen");
    static int count = 1;
    static char name[] = "test_panels";
    static char* arguments[] = {name, nullptr};
    static QApplication application(count, arguments);
  }
};

template <class Widget>
Widget& with_tip(QWidget& parent, const QString& part) {
  for (Widget* found : parent.findChildren<Widget*>())
    if (found->toolTip().contains(part)) return *found;
  throw std::runtime_error("no such box: " + part.toStdString());
}

QPushButton& named(QWidget& parent, const QString& text) {
  for (QPushButton* found : parent.findChildren<QPushButton*>())
    if (found->text() == text) return *found;
  throw std::runtime_error("no such button: " + text.toStdString());
}

void type(QDoubleSpinBox& box, const char* number) {
  box.setFocus();
  box.selectAll();
  QTest::keyClicks(&box, number);
  QTest::keyClick(&box, Qt::Key_Return);
}

void choose(QComboBox& list, int row) {
  list.setFocus();
  while (list.currentIndex() != row)
    QTest::keyClick(&list, list.currentIndex() < row ? Qt::Key_Down : Qt::Key_Up);
}

void click(QWidget& widget) {
  QTest::mouseClick(&widget, Qt::LeftButton, Qt::NoModifier, QPoint(8, widget.height() / 2));
}

TEST_F(Panels, TheViewpointFollowsWhatIsTyped) {
  ViewPose looked;
  ViewStrip strip({.look = [&](const ViewPose& p) { looked = p; }, .named = {}, .act = {}}, nullptr);
  strip.show();
  ViewPose now;
  now.distance = 60;
  strip.show_pose(now, ViewLayout::one, false, false);
  type(with_tip<QDoubleSpinBox>(strip, "Azimuth"), "35");
  EXPECT_NEAR(looked.azimuth, radians_from_degrees(35), 1e-9);
  EXPECT_NEAR(looked.distance, 60, 1e-9);
  type(with_tip<QDoubleSpinBox>(strip, "Elevation"), "-20");
  EXPECT_NEAR(looked.elevation, radians_from_degrees(-20), 1e-9);
  type(with_tip<QDoubleSpinBox>(strip, "Roll"), "90");
  EXPECT_NEAR(looked.roll, radians_from_degrees(90), 1e-9);
  type(with_tip<QDoubleSpinBox>(strip, "Distance"), "123");
  EXPECT_NEAR(looked.distance, 123, 1e-9);
  QDoubleSpinBox& azimuth = with_tip<QDoubleSpinBox>(strip, "Azimuth");
  azimuth.setValue(180);
  QTest::keyClick(&azimuth, Qt::Key_Up);
  EXPECT_LT(looked.azimuth, 0) << "the azimuth goes on behind 180 degrees";
}

TEST_F(Panels, EveryNamedViewAndEveryButtonOfTheStripAsksForItself) {
  std::vector<NamedView> views;
  std::vector<OperatorAction> acts;
  ViewStrip strip({.look = {},
                   .named = [&](NamedView v) { views.push_back(v); },
                   .act = [&](OperatorAction a) { acts.push_back(a); }},
                  nullptr);
  strip.show();
  QComboBox& list = with_tip<QComboBox>(strip, "Named viewpoints");
  ASSERT_EQ(list.count(), kNamedViews + 1);
  for (int i = 1; i <= kNamedViews; ++i) {
    list.setCurrentIndex(i - 1);
    QTest::keyClick(&list, Qt::Key_Down);
    ASSERT_FALSE(views.empty());
    EXPECT_EQ(views.back(), static_cast<NamedView>(i - 1));
    EXPECT_EQ(list.currentIndex(), 0) << "ready for the same view again";
  }
  for (const char* text : {"1", "1+3", "2×2", "Follow", "Flip", "Reset"}) click(named(strip, text));
  EXPECT_EQ(acts, (std::vector{OperatorAction::layout_one, OperatorAction::layout_one_and_three,
                               OperatorAction::layout_two_by_two, OperatorAction::follow_harvester,
                               OperatorAction::flip_harvester, OperatorAction::reset_view}));
}

TEST_F(Panels, ToleranceSoundAndMethodOfNavigationAreTheOperators) {
  NormalChoice chosen = NormalChoice::robust;
  NavigatePage page([&](NormalChoice c) { chosen = c; }, NormalChoice::robust, nullptr);
  page.show();
  type(with_tip<QDoubleSpinBox>(page, "up to this angle"), "5.5");
  type(with_tip<QDoubleSpinBox>(page, "up to this distance"), "1.5");
  EXPECT_EQ(page.tolerance(), (Tolerance{5.5, 1.5}));
  EXPECT_FALSE(page.sound());
  click(with_tip<QCheckBox>(page, "quiet sound"));
  EXPECT_TRUE(page.sound());
  choose(with_tip<QComboBox>(page, "normal is computed"), 1);
  EXPECT_EQ(chosen, NormalChoice::algorithm_1);
}

struct Surface {
  std::vector<Shown> shown;
  MesherOptions made;
  bool smooth = true;
  ColourBy colour = ColourBy::plain;
  int evaluated = 0, region = 0, changed = 0;

  SurfacePage::Hooks hooks() {
    return {.show = [this](Shown s) { shown.push_back(s); },
            .make = [this](const MesherOptions& o) { made = o; },
            .normals = [this](bool on) { smooth = on; },
            .colour = [this](ColourBy c) { colour = c; },
            .evaluation = {.evaluate = [this] { ++evaluated; },
                           .region = [this] { ++region; },
                           .changed = [this] { ++changed; }}};
  }
};

TEST_F(Panels, HowTheSurfaceIsMadeAndShownIsChosenWithMouseAndKeys) {
  Surface told;
  SurfacePage page(told.hooks(), {}, nullptr);
  page.show();
  for (const char* text : {"Points", "3D grid", "Surface", "Wireframe"}) click(named(page, text));
  EXPECT_EQ(told.shown, (std::vector{Shown::points, Shown::grid, Shown::surface, Shown::wireframe}));
  type(with_tip<QDoubleSpinBox>(page, "Cubic interval"), "0.635");
  EXPECT_DOUBLE_EQ(told.made.interval, 0.635);
  click(with_tip<QCheckBox>(page, "Close small holes"));
  EXPECT_GT(told.made.fill_holes_up_to, 0);
  choose(with_tip<QComboBox>(page, "method"), 0);
  EXPECT_EQ(told.made.method, MeshMethod::proposed_cubes);
  EXPECT_FALSE(with_tip<QCheckBox>(page, "Close small holes").isEnabled())
      << "the closed skin of the marching cubes has no holes to close";
  click(with_tip<QCheckBox>(page, "Shade"));
  EXPECT_FALSE(told.smooth);
  QComboBox& colours = with_tip<QComboBox>(page, "Colour of points and surface");
  ASSERT_EQ(colours.count(), 5);
  for (int i = 1; i < 5; ++i) {
    choose(colours, i);
    EXPECT_EQ(told.colour, static_cast<ColourBy>(colours.itemData(i).toInt()));
  }
}

TEST_F(Panels, HolesThatStayOpenAreSaidWithTheirReason) {
  Surface told;
  SurfacePage page(told.hooks(), {}, nullptr);
  page.show();
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh->triangles = {{0, 1, 2}};
  auto surface = std::make_shared<SurfaceView>();
  surface->mesh = mesh;
  ViewState state;
  state.surface = surface;
  page.show_state(state, "");
  EXPECT_EQ(page.size_text(), "1 triangles, 0 grid points") << "nobody asked for closing holes";
  page.toggle_holes();
  page.show_state(state, "");
  EXPECT_EQ(page.size_text(), "1 triangles, 0 grid points") << "this mesh was made before, or is from a file";
  surface->holes = {.filled = 2, .left = 4, .too_long = 3, .too_many = 0, .crossing = 1};
  page.show_state(state, "");
  EXPECT_EQ(page.size_text(),
            "1 triangles · 2 holes closed, 4 open: 3 with too long a rim, 1 whose rim crosses itself");
}

TEST_F(Panels, TheEvaluationTakesShapeNominalValueAndRegion) {
  Surface told;
  EvaluationBox box(told.hooks().evaluation, nullptr);
  box.show();
  choose(with_tip<QComboBox>(box, "Next shape"), static_cast<int>(Shape::sphere));
  type(with_tip<QDoubleSpinBox>(box, "Nominal diameter"), "49.1");
  type(with_tip<QDoubleSpinBox>(box, "Radius of the region"), "7.5");
  EXPECT_EQ(box.request().shape, Shape::sphere);
  EXPECT_DOUBLE_EQ(box.request().nominal, 49.1);
  EXPECT_DOUBLE_EQ(box.request().region.radius, 7.5);
  EXPECT_TRUE(box.request().region.all);
  click(named(box, "All points"));
  EXPECT_EQ(told.region, 1);
  click(named(box, "Evaluate"));
  EXPECT_EQ(told.evaluated, 1);
  EXPECT_GE(told.changed, 1) << "the region is drawn with its new radius";
}

TEST_F(Panels, EveryButtonOnTopAsksForItsAction) {
  std::vector<OperatorAction> acts;
  TopBar bar([&](OperatorAction a) { acts.push_back(a); }, nullptr);
  bar.show();
  bar.show_scanning(false, true, false);
  for (const char* text : {"Scan", "Clear", "Undo", "Surface", "Navi", "Save", "Open", "Diagnostics", "Keys"})
    click(named(bar, text));
  EXPECT_EQ(acts, (std::vector{OperatorAction::scan, OperatorAction::clear, OperatorAction::undo_sweep,
                               OperatorAction::surface, OperatorAction::navigate,
                               OperatorAction::save_session, OperatorAction::open_session,
                               OperatorAction::diagnostics, OperatorAction::shortcuts}));
  bar.show_scanning(false, false, false);
  click(named(bar, "Scan"));
  EXPECT_EQ(acts.size(), 9u) << "without a daemon there is nothing to start";
}

TEST_F(Panels, LongWorkShowsItsProgressAndCanBeGivenUp) {
  int given_up = 0;
  BannerBar bar([&] { ++given_up; }, nullptr);
  bar.resize(1000, bar.height());
  bar.show();
  auto& progress = *bar.findChild<QProgressBar*>();
  EXPECT_FALSE(progress.isVisible());
  bar.show_job(std::pair{QString("saving"), 0.4});
  EXPECT_TRUE(progress.isVisible());
  EXPECT_EQ(progress.value(), 40);
  EXPECT_TRUE(progress.format().contains("saving"));
  click(named(bar, "Cancel"));
  EXPECT_EQ(given_up, 1);
  bar.show_job(std::nullopt);
  EXPECT_FALSE(progress.isVisible());
}

}  // namespace
}  // namespace linescope
