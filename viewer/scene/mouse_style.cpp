#include "viewer/scene/mouse_style.hpp"

#include <vtkObjectFactory.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>

#include <cstdlib>

namespace linescope {
namespace {

constexpr int kStillClick = 3;  ///< px the mouse may move during a click

}  // namespace

vtkStandardNewMacro(MouseStyle)

    void MouseStyle::OnLeftButtonDown() {
  const int* at = Interactor->GetEventPosition();
  down_x_ = at[0];
  down_y_ = at[1];
  FindPokedRenderer(at[0], at[1]);
  if (CurrentRenderer == nullptr) return;
  if (may_turn && !may_turn(CurrentRenderer)) {
    StartPan();
    return;
  }
  Superclass::OnLeftButtonDown();
}

void MouseStyle::OnLeftButtonUp() {
  const int* at = Interactor->GetEventPosition();
  const bool still = std::abs(at[0] - down_x_) <= kStillClick && std::abs(at[1] - down_y_) <= kStillClick;
  Superclass::OnLeftButtonUp();
  if (still && clicked) clicked(at[0], at[1]);
}

void MouseStyle::OnMouseMove() {
  Superclass::OnMouseMove();
  if (State != VTKIS_NONE) tell();
}

void MouseStyle::OnMouseWheelForward() {
  Superclass::OnMouseWheelForward();
  tell();
}

void MouseStyle::OnMouseWheelBackward() {
  Superclass::OnMouseWheelBackward();
  tell();
}

void MouseStyle::tell() {
  if (moved && CurrentRenderer != nullptr) moved(CurrentRenderer);
}

}  // namespace linescope
