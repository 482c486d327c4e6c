#include "tests/integration/viewer/viewer_under_test.hpp"

#include <QFile>
#include <QJsonDocument>

namespace linescope::testing {
namespace {

std::vector<std::string> command(const std::string& segment, const std::filesystem::path& state,
                                 const std::vector<std::string>& more) {
  std::vector<std::string> words = {LINESCOPE_VIEWER, "--segment", segment, "--state-json", state.string()};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

}  // namespace

ViewerUnderTest::ViewerUnderTest(const std::string& segment, const VirtualDisplay& display,
                                 std::vector<std::string> arguments, const std::string& settings)
    : display_(display),
      process_(
          command(segment, folder_.path() / "state.json", arguments),
          {display.variable(),
           "XDG_CONFIG_HOME=" + (settings.empty() ? (folder_.path() / "settings").string() : settings)}) {}

QJsonObject ViewerUnderTest::shown() const {
  QFile file(QString::fromStdString((folder_.path() / "state.json").string()));
  if (!file.open(QIODevice::ReadOnly)) return {};
  return QJsonDocument::fromJson(file.readAll()).object();
}

bool ViewerUnderTest::shows(const std::function<bool(const QJsonObject&)>& condition,
                            std::chrono::seconds timeout) const {
  return eventually([&] { return condition(shown()); }, timeout);
}

bool ViewerUnderTest::xdotool(std::vector<std::string> arguments) const {
  arguments.insert(arguments.begin(), "xdotool");
  ChildProcess tool(arguments, {display_.variable()});
  const auto end = tool.wait(std::chrono::seconds(10));
  return end && !end->signalled && end->code == 0;
}

bool ViewerUnderTest::press(const std::string& key) const {
  // There is no window manager under Xvfb that would give the window the focus.
  return xdotool({"search", "--onlyvisible", "--name", "not for clinical use", "windowfocus", "--sync"}) &&
         xdotool({"key", key});
}

bool ViewerUnderTest::click(int x, int y) const {
  return xdotool({"search", "--onlyvisible", "--name", "not for clinical use", "mousemove", "--window", "%1",
                  std::to_string(x), std::to_string(y), "click", "1"});
}

}  // namespace linescope::testing
