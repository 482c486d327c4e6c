#include "viewer/panel/surface_page.hpp"

#include <fmt/format.h>

#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QPushButton>
#include <algorithm>

#include "viewer/panel/operator_action.hpp"
#include "viewer/surface_worker.hpp"

namespace linescope {
namespace {

constexpr const char* kShownNames[kShown] = {"Points", "3D grid", "Surface", "Wireframe"};
constexpr OperatorAction kShownActions[kShown] = {OperatorAction::show_points, OperatorAction::show_grid,
                                                  OperatorAction::show_surface,
                                                  OperatorAction::show_wireframe};
constexpr MeshMethod kMethods[] = {MeshMethod::proposed_cubes, MeshMethod::implicit,
                                   MeshMethod::classical_cubes};
constexpr double kLargestRim = 20;  // mm: a hole some 6 mm across
constexpr ColourBy kColours[] = {ColourBy::plain, ColourBy::height, ColourBy::uncertainty, ColourBy::age,
                                 ColourBy::coverage};

/// In one row: the page has no room for another on a small screen.
std::string size_of(const SurfaceView& s) {
  const std::string triangles = fmt::format("{} triangles", grouped(s.mesh->triangle_count()));
  if (s.holes) return triangles + " · " + in_words(*s.holes);
  const std::string filled = s.filled > 0 ? fmt::format(" ({} close holes)", grouped(s.filled)) : "";
  return fmt::format("{}{}, {} grid points", triangles, filled, grouped(s.grid ? s.grid->size() : 0));
}

}  // namespace

SurfacePage::SurfacePage(Hooks hooks, const MesherOptions& options, QWidget* parent)
    : SidePage(parent), hooks_(std::move(hooks)), options_(options) {
  add_shown();
  add_making();
  add_colours();
  add_heading("Result");
  made_of_ = add_row("Made of");
  size_ = add_row("Size");
  area_ = add_row("Area");
  drawn_ = add_row("Drawn");
  measured_ = add_row("Distance");
  clear_measurement();
  evaluation_ = new EvaluationBox(hooks_.evaluation, this);
  column_->addWidget(evaluation_);
  column_->addStretch(1);
  set_shown(Shown::points);
}

void SurfacePage::add_shown() {
  add_heading("Show");
  auto* row = new QHBoxLayout;
  row->setSpacing(scaled(4));
  for (int i = 0; i < kShown; ++i) {
    auto* button = new QPushButton(kShownNames[i], this);
    button->setObjectName("small");
    button->setCheckable(true);
    button->setFocusPolicy(Qt::TabFocus);
    button->setToolTip(tooltip(kShownActions[i]));
    connect(button, &QPushButton::clicked, this, [this, i] { hooks_.show(static_cast<Shown>(i)); });
    row->addWidget(button, 1);
    show_buttons_[static_cast<std::size_t>(i)] = button;
  }
  column_->addLayout(row);
}

void SurfacePage::add_making() {
  add_heading("Make");
  method_ = new QComboBox(this);
  for (const MeshMethod method : kMethods)
    method_->addItem(QString::fromStdString(name(method)), static_cast<int>(method));
  method_->setCurrentIndex(method_->findData(static_cast<int>(options_.method)));
  method_->setToolTip(tooltip(OperatorAction::method));
  interval_ = new QDoubleSpinBox(this);
  interval_->setRange(0.2, 10);
  interval_->setDecimals(3);
  interval_->setSingleStep(0.1);
  interval_->setSuffix(" mm");
  interval_->setKeyboardTracking(false);
  interval_->setValue(options_.interval);
  interval_->setToolTip("Cubic interval t; the thesis used 0.635, 1.27, 2.54 and 5.08 mm  ([ and ])");
  column_->addWidget(method_);
  auto* row = new QHBoxLayout;
  auto* label = new QLabel("Interval t", this);
  label->setFixedWidth(scaled(92));
  row->addWidget(label);
  row->addWidget(interval_, 1);
  column_->addLayout(row);
  holes_ = new QCheckBox("Close holes", this);
  holes_->setToolTip(tooltip(OperatorAction::close_holes));
  row->addWidget(holes_);
  mirror_holes();
  connect(holes_, &QCheckBox::toggled, this, [this] { options_changed(); });
  connect(method_, QOverload<int>::of(&QComboBox::currentIndexChanged), this, [this] { options_changed(); });
  connect(interval_, QOverload<double>::of(&QDoubleSpinBox::valueChanged), this,
          [this] { options_changed(); });
}

void SurfacePage::add_colours() {
  normals_ = new QCheckBox("Normals", this);
  normals_->setChecked(true);
  normals_->setToolTip(tooltip(OperatorAction::normals));
  colour_ = new QComboBox(this);
  for (const ColourBy what : kColours)
    colour_->addItem(QString("Colour: %1").arg(QString(name(what)).toLower()), static_cast<int>(what));
  colour_->setToolTip(
      "Colour of points and surface; age exists for points only, coverage for the surface only");
  auto* row = new QHBoxLayout;
  normals_->setFixedWidth(scaled(92));
  row->addWidget(normals_);
  row->addWidget(colour_, 1);
  column_->addLayout(row);
  connect(normals_, &QCheckBox::toggled, this, [this](bool on) { hooks_.normals(on); });
  connect(colour_, QOverload<int>::of(&QComboBox::currentIndexChanged), this,
          [this] { hooks_.colour(static_cast<ColourBy>(colour_->currentData().toInt())); });
}

void SurfacePage::options_changed() {
  options_.method = static_cast<MeshMethod>(method_->currentData().toInt());
  options_.interval = interval_->value();
  options_.fill_holes_up_to = holes_->isChecked() ? kLargestRim : 0;
  mirror_holes();
  hooks_.make(options_);
}

void SurfacePage::set_shown(Shown shown) {
  shown_ = shown;
  for (std::size_t i = 0; i < kShown; ++i) show_buttons_[i]->setChecked(i == static_cast<std::size_t>(shown));
}

void SurfacePage::next_method() {
  method_->setCurrentIndex((method_->currentIndex() + 1) % method_->count());
}

void SurfacePage::step_interval(bool finer) {
  const auto begin = std::begin(kThesisIntervals), end = std::end(kThesisIntervals);
  const double now = options_.interval;
  const auto above = std::upper_bound(begin, end, now + 1e-9), at = std::lower_bound(begin, end, now - 1e-9);
  if (finer && at != begin) interval_->setValue(*(at - 1));
  if (!finer && above != end) interval_->setValue(*above);
}

void SurfacePage::toggle_normals() {
  normals_->toggle();
}

void SurfacePage::toggle_holes() {
  if (holes_->isEnabled()) holes_->toggle();
}

/// The marching cubes of the thesis make a closed skin: there is nothing to close.
void SurfacePage::mirror_holes() {
  const QSignalBlocker quiet(holes_);
  holes_->setChecked(options_.fill_holes_up_to > 0);
  holes_->setEnabled(options_.method == MeshMethod::implicit);
}

void SurfacePage::set_options(const MesherOptions& options) {
  const QSignalBlocker quiet_method(method_), quiet_interval(interval_);
  options_ = options;
  mirror_holes();
  method_->setCurrentIndex(method_->findData(static_cast<int>(options.method)));
  interval_->setValue(options.interval);
}

void SurfacePage::set_colouring(ColourBy what, bool smooth) {
  colour_->setCurrentIndex(colour_->findData(static_cast<int>(what)));
  normals_->setChecked(smooth);
}

ColourBy SurfacePage::colouring() const {
  return static_cast<ColourBy>(colour_->currentData().toInt());
}

bool SurfacePage::smooth() const {
  return normals_->isChecked();
}

void SurfacePage::show_measurement(const QString& text) {
  measured_->set_text(text);
}

void SurfacePage::clear_measurement() {
  show_measurement("press D, then click two points");
}

void SurfacePage::show_state(const ViewState& state, const std::string& drawn) {
  const SurfaceView& s = *state.surface;
  drawn_->set_text(QString::fromStdString(
      drawn + (s.took > 0 ? fmt::format(" · made in {:.1f} ms", milliseconds_from(s.took)) : "")));
  if (!s.fault.empty()) return made_of_->set_text(QString::fromStdString(s.fault));
  made_of_->set_text(QString::fromStdString(
      fmt::format("{} points, {} lines{}", grouped(s.points), grouped(s.lines),
                  s.points_refused > 0 ? fmt::format(" ({} refused)", grouped(s.points_refused)) : "")));
  const bool any = s.mesh && !s.mesh->empty();
  size_->set_text(any ? QString::fromStdString(size_of(s)) : QStringLiteral("– –  no surface yet"));
  area_->set_text(
      any ? QString("%1 mm², %2 mm² of it seen").arg(s.area, 0, 'f', 0).arg(s.seen_area, 0, 'f', 0)
          : QStringLiteral("– –"));
}

}  // namespace linescope
