// linescope-viewer. Not for clinical use.
#include <fmt/format.h>

#include <QApplication>
#include <cstdlib>

#include "viewer/panel/scene_widget.hpp"
#include "viewer/panel/theme.hpp"
#include "viewer/remembered.hpp"
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

/// What the command line says, and where it says nothing what the last run remembered. Scripts and pictures
/// begin the same every time.
Remembered with_memory(int argc, char** argv, const ViewerOptions& plain) {
  if (!plain.remember || !plain.script.empty()) return {plain, {}};
  Remembered memory = recall();
  auto read = read_viewer_options(argc, argv, memory.options);
  if (!read || !std::holds_alternative<ViewerOptions>(*read)) return {plain, {}};
  return {std::get<ViewerOptions>(*read), memory.window};
}

int run(int argc, char** argv, const ViewerOptions& plain) {
  const Remembered settings = with_memory(argc, argv, plain);
  const ViewerOptions& options = settings.options;
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
  ViewerApp viewer(options, std::move(script), settings.window);
  const ExitCode end = viewer.run();
  if (options.remember && options.script.empty()) remember({viewer.options(), viewer.preferences()});
  return exit_status(end);
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
