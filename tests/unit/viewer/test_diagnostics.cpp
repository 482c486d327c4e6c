// The diagnostics as text for a report, and the button that copies them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <QApplication>
#include <QClipboard>
#include <QPushButton>

#include "viewer/panel/dialogs.hpp"

namespace linescope {
namespace {

using ::testing::HasSubstr;

ViewState state() {
  LiveView live;
  live.link.segment = "some-segment";
  live.camera.rate_hz = 29.97;
  auto figures = std::make_shared<DiagnosticsView>();
  figures->counters = {{"frames without a line", 1'234}};
  figures->latencies = {{"line extraction", 55, 4 * kMillisecond, 7 * kMillisecond, 9 * kMillisecond}};
  live.diagnostics = figures;
  ViewState s;
  s.live = std::make_shared<const LiveView>(live);
  return s;
}

TEST(Diagnostics, CopyPutsEveryPageOnTheClipboard) {
  qputenv("QT_QPA_PLATFORM", "offscreen");
  int argc = 1;
  char name[] = "test";
  char* argv[] = {name, nullptr};
  QApplication application(argc, argv);
  DiagnosticsDialog dialog(nullptr);
  DisplayFigures display;
  display.wait_p95_ms = 12.5;
  display.stages = {
      {"tracker sample to screen", 77, 20 * kMillisecond, 41 * kMillisecond, 60 * kMillisecond}};
  dialog.show_state(state(), display, {"1.000  Session saved"});
  QPushButton* copy = nullptr;
  for (QPushButton* button : dialog.findChildren<QPushButton*>())
    if (button->text() == "Copy diagnostics") copy = button;
  ASSERT_NE(copy, nullptr);
  copy->click();
  const std::string text = QApplication::clipboard()->text().toStdString();
  for (const char* part : {"not for clinical use", "some-segment", "30.0 Hz", "12.5 ms",
                           "frames without a line", "1,234", "line extraction\t4.00\t7.00\t9.00\t55",
                           "tracker sample to screen\t20.00\t41.00\t60.00\t77", "Session saved"})
    EXPECT_THAT(text, HasSubstr(part));
}

}  // namespace
}  // namespace linescope
