// linescope-viewer. Not for clinical use.
#include <fmt/format.h>

#include <QApplication>
#include <cstdlib>

#include "viewer/panel/scene_widget.hpp"
#include "viewer/panel/theme.hpp"
#include "viewer/viewer_app.hpp"

namespace linescope {
namespace {

int refuse(const Refusal& refusal) {
  fmt::print(stderr, "linescope-viewer: {}\n", refusal.message);
  return exit_status(refusal.exit);
}

bool display_missing() {
  const auto set = [](const char* name) {
    return std::getenv(name) != nullptr && *std::getenv(name) != '\0';
  };
  return !set("DISPLAY") && !set("WAYLAND_DISPLAY") && !set("QT_QPA_PLATFORM");
}

int run(int argc, char** argv, const ViewerOptions& options) {
  std::vector<Step> script;
  if (!options.script.empty()) {
    auto loaded = load_script(options.script);
    if (!loaded) return refuse({ExitCode::usage, loaded.error().message});
    script = std::move(*loaded);
  }
  if (display_missing())
    return refuse({ExitCode::failed,
                   "there is no display: run under a desktop, or headless with "
                   "xvfb-run -s \"-screen 0 1920x1080x24\" linescope-viewer ..."});
  prepare_graphics();
  QApplication::setAttribute(Qt::AA_EnableHighDpiScaling);
  QApplication application(argc, argv);
  QApplication::setApplicationName("linescope-viewer");
  QApplication::setStyle("Fusion");
  QApplication::setPalette(dark_palette());
  set_panel_scale(options.font_scale);
  ViewerApp viewer(options, std::move(script));
  return exit_status(viewer.run());
}

}  // namespace
}  // namespace linescope

int main(int argc, char** argv) {
  auto read = linescope::read_viewer_options(argc, argv);
  if (!read) return linescope::refuse(read.error());
  if (const auto* printed = std::get_if<linescope::Printed>(&*read)) {
    fmt::print("{}", printed->text);
    return 0;
  }
  return linescope::run(argc, argv, std::get<linescope::ViewerOptions>(*read));
}
