#include "viewer/panel/navigate_page.hpp"

#include <fmt/format.h>

#include <QApplication>
#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <cmath>

#include "common/units.hpp"

namespace linescope {
namespace {

QDoubleSpinBox* limit_box(QWidget* parent, double value, double most, const char* suffix, const char* tip) {
  auto* box = new QDoubleSpinBox(parent);
  box->setRange(0.5, most);
  box->setDecimals(1);
  box->setSingleStep(0.5);
  box->setValue(value);
  box->setSuffix(suffix);
  box->setToolTip(tip);
  return box;
}

}  // namespace

NavigatePage::NavigatePage(std::function<void(NormalChoice)> choose, NormalChoice choice, QWidget* parent)
    : SidePage(parent), bullseye_(new Bullseye(this)) {
  column_->addWidget(bullseye_, 1);
  distance_ = add_row("Distance");
  depth_ = add_row("Along axis");
  uncertainty_ = add_row("Normal ±");
  basis_ = add_row("Rests on");
  held_ = add_row("Held");
  add_tolerance();
  method_ = new QComboBox(this);
  for (const NormalChoice c : {NormalChoice::robust, NormalChoice::algorithm_1})
    method_->addItem(QString::fromStdString(name(c)), static_cast<int>(c));
  method_->setCurrentIndex(method_->findData(static_cast<int>(choice)));
  method_->setToolTip("How the surface normal is computed");
  column_->addWidget(method_);
  connect(method_, QOverload<int>::of(&QComboBox::currentIndexChanged), this,
          [this, choose] { choose(static_cast<NormalChoice>(method_->currentData().toInt())); });
}

void NavigatePage::add_tolerance() {
  auto* row = new QHBoxLayout;
  auto* label = new QLabel("Tolerance", this);
  label->setFixedWidth(scaled(92));
  const Tolerance usual;
  angle_limit_ = limit_box(this, usual.angle_deg, 20, "°", "The harvester is on target up to this angle");
  distance_limit_ = limit_box(this, usual.distance_mm, 20, " mm",
                              "... and up to this distance of its tip from the surface");
  sound_ = new QCheckBox("Sound", this);
  sound_->setToolTip("A quiet sound when the harvester was held within the tolerance for half a second");
  row->addWidget(label);
  row->addWidget(angle_limit_);
  row->addWidget(distance_limit_);
  row->addWidget(sound_);
  column_->addLayout(row);
}

Tolerance NavigatePage::tolerance() const {
  return {angle_limit_->value(), distance_limit_->value()};
}

bool NavigatePage::sound() const {
  return sound_->isChecked();
}

void NavigatePage::set_preferences(const Tolerance& tolerance, bool sound) {
  angle_limit_->setValue(tolerance.angle_deg);
  distance_limit_->setValue(tolerance.distance_mm);
  sound_->setChecked(sound);
}

void NavigatePage::show_hold(const AngleReadout& angle) {
  held_->set_text(angle.held           ? mark(Mood::good) + " held"
                  : angle.in_tolerance ? QString("in tolerance, %1 %").arg(100 * angle.held_share, 0, 'f', 0)
                                       : QStringLiteral("– –"));
  held_->set_colour(angle.held ? colour(Mood::good) : colour(palette::kText));
  if (!angle.held)
    told_ = false;
  else if (!std::exchange(told_, true) && sound_->isChecked())
    QApplication::beep();
}

void NavigatePage::show_state(const AngleReadout& angle, const std::optional<BullseyeReading>& tilts,
                              const NavigationView& navigation) {
  bullseye_->show_reading(tilts);
  distance_->set_text(text_of(angle.distance));
  depth_->set_text(text_of(angle.depth));
  const bool blank = angle.angle.blank();
  uncertainty_->set_text(
      blank || !std::isfinite(navigation.uncertainty)
          ? QStringLiteral("– –")
          : QString("%1° (95 %)").arg(degrees_from_radians(navigation.uncertainty), 0, 'f', 1));
  basis_->set_text(blank ? QStringLiteral("– –")
                         : QString::fromStdString(fmt::format(
                               "{} points, {} lines", grouped(static_cast<std::uint64_t>(navigation.points)),
                               navigation.lines)));
  show_hold(angle);
}

}  // namespace linescope
