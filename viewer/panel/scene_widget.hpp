// The scene in the window.
#pragma once

#include <QVTKOpenGLNativeWidget.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkNew.h>

#include <memory>

#include "viewer/scene/scene.hpp"

namespace linescope {

/// What must happen before QApplication is made, so that the views get the kind of surface VTK draws on.
void prepare_graphics();

class SceneWidget : public QVTKOpenGLNativeWidget {
 public:
  explicit SceneWidget(QWidget* parent);
  ~SceneWidget() override;

  Scene& scene() { return *scene_; }
  /// Draws when something changed; true when it did.
  bool draw_if_needed();
  /// Name of the graphics driver, for the diagnostics; empty before the first picture.
  const std::string& graphics() const { return graphics_; }

 private:
  void learn_graphics();

  vtkNew<vtkGenericOpenGLRenderWindow> window_;
  std::unique_ptr<Scene> scene_;
  std::string graphics_;
};

}  // namespace linescope
