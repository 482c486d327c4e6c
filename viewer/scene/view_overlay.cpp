#include "viewer/scene/view_overlay.hpp"

#include <fmt/format.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkMatrix4x4.h>
#include <vtkPolyDataMapper2D.h>
#include <vtkProperty2D.h>
#include <vtkRenderWindow.h>
#include <vtkTextProperty.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "viewer/scene/palette.hpp"

namespace linescope {
namespace {

constexpr double kUsualDpi = 72;  // VTK's word for one pixel per pixel
// Pixels there.
constexpr double kMargin = 14, kAxisLength = 30, kTick = 5;
constexpr double kBarShare = 0.25;  ///< of the view's width, at most
constexpr Rgb kAxisColours[3] = {palette::of(0xd55e00), palette::of(0x2fc79b), palette::of(0x56b4e9)};

void style(vtkTextActor& text, double size, const Rgb& colour) {
  vtkTextProperty& p = *text.GetTextProperty();
  p.SetFontFamilyToArial();
  p.SetFontSize(static_cast<int>(std::lround(size)));
  p.SetColor(colour[0], colour[1], colour[2]);
}

/// In pixels of the view, not of the window.
void place(vtkTextActor& text, double x, double y) {
  text.SetPosition(std::round(x), std::round(y));
}

/// Millimetres per pixel at the point the camera looks at.
double millimetres_per_pixel(vtkRenderer& renderer) {
  vtkCamera& camera = *renderer.GetActiveCamera();
  const int height = std::max(renderer.GetSize()[1], 1);
  const double half = camera.GetParallelProjection() != 0
                          ? camera.GetParallelScale()
                          : camera.GetDistance() * std::tan(camera.GetViewAngle() * std::numbers::pi / 360.0);
  return 2.0 * half / height;
}

}  // namespace

double round_length(double longest) {
  const double power = std::pow(10.0, std::floor(std::log10(longest)));
  for (const double step : {5.0, 2.0})
    if (step * power <= longest) return step * power;
  return power;
}

ViewOverlay::ViewOverlay(vtkRenderer& renderer) : renderer_(renderer) {
  for (std::size_t i = 0; i < 3; ++i) {
    make(axes_[i], 2, kAxisColours[i].data());
    const char* const names[] = {"x", "y", "z"};
    axis_names_[i]->SetInput(names[i]);
    axis_names_[i]->GetTextProperty()->SetJustificationToCentered();
    axis_names_[i]->GetTextProperty()->SetVerticalJustificationToCentered();
    renderer_.AddActor2D(axis_names_[i]);
  }
  make(bar_, 4, palette::kText.data());
  bar_text_->GetTextProperty()->SetJustificationToRight();
  title_->GetTextProperty()->SetVerticalJustificationToTop();
  note_->GetTextProperty()->SetVerticalJustificationToTop();
  for (vtkTextActor* text : {bar_text_.Get(), title_.Get(), note_.Get()}) renderer_.AddActor2D(text);
  set_scale(1);
}

void ViewOverlay::make(Line& line, int points, const double* colour) {
  vtkNew<vtkCellArray> cells;
  cells->InsertNextCell(points);
  for (int i = 0; i < points; ++i) cells->InsertCellPoint(i);
  line.points->SetNumberOfPoints(points);
  line.data->SetPoints(line.points);
  line.data->SetLines(cells);
  vtkNew<vtkPolyDataMapper2D> mapper;
  mapper->SetInputData(line.data);
  line.actor->SetMapper(mapper);
  line.actor->GetProperty()->SetColor(colour[0], colour[1], colour[2]);
  renderer_.AddActor2D(line.actor);
}

void ViewOverlay::set_title(const std::string& title) {
  title_->SetInput(title.c_str());
}
void ViewOverlay::set_note(const std::string& note) {
  note_->SetInput(note.c_str());
}

void ViewOverlay::set_scale(double scale) {
  scale_ = scale;
  style(*title_, 14 * scale, palette::kText);
  style(*note_, 12 * scale, palette::kQuiet);
  style(*bar_text_, 12 * scale, palette::kText);
  for (std::size_t i = 0; i < 3; ++i) style(*axis_names_[i], 13 * scale, kAxisColours[i]);
}

void ViewOverlay::set_line_widths() {
  for (Line& axis : axes_) axis.actor->GetProperty()->SetLineWidth(static_cast<float>(2 * pixels_));
  bar_.actor->GetProperty()->SetLineWidth(static_cast<float>(1.5 * pixels_));
}

/// VTK itself makes text larger on a screen of many pixels per inch; places and lengths are ours to follow.
void ViewOverlay::update() {
  const double pixels = scale_ * renderer_.GetRenderWindow()->GetDPI() / kUsualDpi;
  if (std::exchange(pixels_, pixels) != pixels) set_line_widths();
  const double height = renderer_.GetSize()[1];
  place(*title_, kMargin * pixels_, height - 10 * pixels_);
  place(*note_, kMargin * pixels_, height - 30 * pixels_);
  update_axes();
  update_bar();
}

void ViewOverlay::update_axes() {
  vtkMatrix4x4& view = *renderer_.GetActiveCamera()->GetViewTransformMatrix();
  const double length = kAxisLength * pixels_, middle = (kMargin + 14) * pixels_ + length;
  for (std::size_t i = 0; i < 3; ++i) {
    const int column = static_cast<int>(i);
    const double x = view.GetElement(0, column), y = view.GetElement(1, column);
    axes_[i].points->SetPoint(0, middle, middle, 0);
    axes_[i].points->SetPoint(1, middle + length * x, middle + length * y, 0);
    axes_[i].points->Modified();
    // An axis that points at the eye has its name beside the origin instead of on it.
    const double reach = length + 10 * pixels_, shown = std::hypot(x, y);
    const double nx = shown < 0.25 ? -0.35 : x, ny = shown < 0.25 ? -0.35 : y;
    place(*axis_names_[i], middle + reach * nx, middle + reach * ny);
  }
}

void ViewOverlay::update_bar() {
  const double per_pixel = millimetres_per_pixel(renderer_);
  const double width = renderer_.GetSize()[0];
  bar_mm_ = round_length(std::max(width * kBarShare * per_pixel, 1e-6));
  const double right = width - kMargin * pixels_, left = right - bar_mm_ / per_pixel;
  const double low = kMargin * pixels_, tick = kTick * pixels_;
  bar_.points->SetPoint(0, left, low + tick, 0);
  bar_.points->SetPoint(1, left, low, 0);
  bar_.points->SetPoint(2, right, low, 0);
  bar_.points->SetPoint(3, right, low + tick, 0);
  bar_.points->Modified();
  bar_text_->SetInput(fmt::format("{:g} mm", bar_mm_).c_str());
  place(*bar_text_, right, low + tick + 3 * pixels_);
}

}  // namespace linescope
