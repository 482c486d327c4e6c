// The mouse camera: left turns (in the free view), middle or shift-left moves, wheel or right zooms.
#pragma once

#include <vtkInteractorStyleTrackballCamera.h>

#include <functional>

namespace linescope {

class MouseStyle : public vtkInteractorStyleTrackballCamera {
 public:
  static MouseStyle* New();
  vtkTypeMacro(MouseStyle, vtkInteractorStyleTrackballCamera)

      /// Whether a view may be turned; the axis views may not, they are moved instead.
      std::function<bool(vtkRenderer*)> may_turn;
  /// A click without dragging, display coordinates.
  std::function<void(int x, int y)> clicked;
  /// The operator moved a camera.
  std::function<void(vtkRenderer*)> moved;

  void OnLeftButtonDown() override;
  void OnLeftButtonUp() override;
  void OnMouseMove() override;
  void OnMouseWheelForward() override;
  void OnMouseWheelBackward() override;
  void OnChar() override {}  ///< VTK's own keys would fight with the panel's

 private:
  void tell();

  int down_x_ = 0, down_y_ = 0;
};

}  // namespace linescope
