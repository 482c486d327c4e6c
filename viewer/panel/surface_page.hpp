// The moment "Surface": what is shown of it and how it is made.
#pragma once

#include <array>
#include <functional>

#include "viewer/panel/evaluation_box.hpp"
#include "viewer/scene/colour_scale.hpp"
#include "viewer/surface/mesher_options.hpp"

class QCheckBox;
class QComboBox;
class QDoubleSpinBox;
class QPushButton;

namespace linescope {

enum class Shown : std::uint8_t { points, grid, surface, wireframe };
inline constexpr int kShown = 4;

class SurfacePage : public SidePage {
 public:
  struct Hooks {
    std::function<void(Shown)> show;
    std::function<void(const MesherOptions&)> make;
    std::function<void(bool)> normals;
    std::function<void(ColourBy)> colour;
    EvaluationBox::Hooks evaluation;
  };
  SurfacePage(Hooks hooks, const MesherOptions& options, QWidget* parent);

  void show_state(const ViewState& state, const std::string& drawn);
  /// Mirrors what keys chose.
  void set_shown(Shown shown);
  void next_method();
  void step_interval(bool finer);
  void toggle_normals();
  void toggle_holes();
  void show_measurement(const QString& text);
  void clear_measurement();

  /// The surface was made otherwise than here: a file.
  void set_options(const MesherOptions& options);
  void set_colouring(ColourBy what, bool smooth);
  ColourBy colouring() const;
  bool smooth() const;

  EvaluationBox& evaluation() { return *evaluation_; }
  const EvaluationBox& evaluation() const { return *evaluation_; }
  QString measurement() const { return measured_->text(); }
  QString size_text() const { return size_->text(); }
  Shown shown() const { return shown_; }
  const MesherOptions& options() const { return options_; }

 private:
  void add_shown();
  void add_making();
  void add_colours();
  void options_changed();
  void mirror_holes();

  Hooks hooks_;
  MesherOptions options_;
  Shown shown_ = Shown::points;
  std::array<QPushButton*, kShown> show_buttons_{};
  QComboBox *method_, *colour_;
  QDoubleSpinBox* interval_;
  QCheckBox *normals_, *holes_;
  ElidedLabel *made_of_, *size_, *area_, *drawn_, *measured_;
  EvaluationBox* evaluation_;
};

}  // namespace linescope
