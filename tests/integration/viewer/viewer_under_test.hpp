// The real linescope-viewer under Xvfb, what its window says, and real keys and clicks into it.
#pragma once

#include <QJsonObject>
#include <string>
#include <vector>

#include "tests/support/child_process.hpp"
#include "tests/support/virtual_display.hpp"

namespace linescope::testing {

class ViewerUnderTest {
 public:
  /// `settings`: folder of what is remembered; empty: one of its own.
  ViewerUnderTest(const std::string& segment, const VirtualDisplay& display,
                  std::vector<std::string> arguments = {}, const std::string& settings = {});

  ChildProcess& process() { return process_; }

  /// What is displayed; empty before the window is up.
  QJsonObject shown() const;
  std::string text(const char* key) const { return shown()[key].toString().toStdString(); }
  bool shows(const std::function<bool(const QJsonObject&)>& condition,
             std::chrono::seconds timeout = std::chrono::seconds(30)) const;

  /// A real key press into the window, as xdotool names it; a foot pedal is the same.
  bool press(const std::string& key) const;
  /// A real click, pixels from the window's top left corner.
  bool click(int x, int y) const;

 private:
  bool xdotool(std::vector<std::string> arguments) const;

  const VirtualDisplay& display_;
  TemporaryFolder folder_;
  ChildProcess process_;
};

}  // namespace linescope::testing
