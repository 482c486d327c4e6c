#include "viewer/panel/scene_widget.hpp"

#include <vtkRenderWindowInteractor.h>

#include <QSurfaceFormat>
#include <cstdlib>

#include "viewer/panel/theme.hpp"

namespace linescope {
namespace {

// What can be drawn in time: a graphics processor takes millions, a software renderer about 2 points per
// microsecond.
constexpr std::size_t kPointsOnHardware = 2'000'000;
constexpr std::size_t kPointsInSoftware = 60'000;

bool is_software(const std::string& renderer) {
  for (const char* name : {"llvmpipe", "softpipe", "SWR", "swrast", "Software"})
    if (renderer.find(name) != std::string::npos) return true;
  return false;
}

std::string renderer_line(const char* capabilities) {
  const std::string text = capabilities == nullptr ? "" : capabilities;
  const std::size_t at = text.find("OpenGL renderer string:");
  if (at == std::string::npos) return {};
  const std::size_t from = text.find_first_not_of(' ', at + 23);
  return text.substr(from, text.find('\n', from) - from);
}

}  // namespace

void prepare_graphics() {
  // VTK's worker threads spin while they wait; the processors belong to the daemon and to the renderer.
  if (std::getenv("VTK_SMP_BACKEND_IN_USE") == nullptr) qputenv("VTK_SMP_BACKEND_IN_USE", "Sequential");
  QSurfaceFormat format = QVTKOpenGLNativeWidget::defaultFormat();
  format.setSamples(0);  // the render window multisamples on its own; twice costs twice
  QSurfaceFormat::setDefaultFormat(format);
}

SceneWidget::SceneWidget(QWidget* parent) : QVTKOpenGLNativeWidget(parent) {
  window_->SetMultiSamples(0);
  setRenderWindow(window_);
  scene_ = std::make_unique<Scene>(*window_);
  scene_->cloud().set_budget(kPointsInSoftware);
  scene_->set_text_scale(panel_scale());
  interactor()->SetInteractorStyle(&scene_->mouse());
  setFocusPolicy(Qt::NoFocus);  // the keys belong to the window
  setEnableHiDPI(true);
}

SceneWidget::~SceneWidget() = default;

void SceneWidget::learn_graphics() {
  if (!graphics_.empty()) return;
  graphics_ = renderer_line(window_->ReportCapabilities());
  if (!graphics_.empty() && !is_software(graphics_)) {
    scene_->cloud().set_budget(kPointsOnHardware);
    window_->SetMultiSamples(4);
  }
}

bool SceneWidget::draw_if_needed() {
  if (!isVisible() || !scene_->refresh()) return false;
  window_->Render();
  learn_graphics();
  update();
  return true;
}

}  // namespace linescope
