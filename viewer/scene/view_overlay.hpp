// What every view says about itself: its name, which way x, y and z point, and how long a millimetre is.
#pragma once

#include <vtkActor2D.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkRenderer.h>
#include <vtkTextActor.h>

#include <array>
#include <string>

namespace linescope {

class ViewOverlay {
 public:
  explicit ViewOverlay(vtkRenderer& renderer);

  void set_title(const std::string& title);
  /// Small text below the title, for example how many points are drawn.
  void set_note(const std::string& note);
  /// Sizes of text and markers relative to the usual; the screen's own pixel ratio comes on top.
  void set_scale(double scale);

  /// Before every picture: follows the camera.
  void update();

  /// Length of the scale bar, mm.
  double bar_mm() const { return bar_mm_; }

 private:
  void set_line_widths();
  void update_axes();
  void update_bar();

  struct Line {
    vtkNew<vtkPoints> points;
    vtkNew<vtkPolyData> data;
    vtkNew<vtkActor2D> actor;
  };
  void make(Line& line, int points, const double* colour);

  vtkRenderer& renderer_;
  vtkNew<vtkTextActor> title_, note_, bar_text_;
  std::array<vtkNew<vtkTextActor>, 3> axis_names_;
  std::array<Line, 3> axes_;
  Line bar_;
  double bar_mm_ = 0, scale_ = 1;
  double pixels_ = 0;  ///< of the screen for one of a usual screen and scale 1
};

/// The largest of 1, 2, 5 times a power of ten that is not longer than `longest`.
double round_length(double longest);

}  // namespace linescope
