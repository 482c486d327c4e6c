#include "viewer/panel/view_strip.hpp"

#include <QComboBox>
#include <QDoubleSpinBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QSignalBlocker>

#include "common/units.hpp"
#include "viewer/panel/theme.hpp"

namespace linescope {

ViewStrip::ViewStrip(Hooks hooks, QWidget* parent) : QFrame(parent), hooks_(std::move(hooks)) {
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(scaled(8), scaled(4), scaled(8), scaled(4));
  row->setSpacing(scaled(5));
  azimuth_ = add_box("Az", -180, 180, "°", "Azimuth of the viewpoint about the object's z axis");
  elevation_ = add_box("El", -90, 90, "°", "Elevation of the viewpoint above the object's xy plane");
  roll_ = add_box("Roll", -180, 180, "°", "Roll about the direction of view");
  distance_ = add_box("Dist", 5, 2000, "", "Distance of the viewpoint, mm");
  azimuth_->setWrapping(true);
  roll_->setWrapping(true);
  auto* named = new QComboBox(this);
  named->addItem("View …");
  for (int i = 0; i < kNamedViews; ++i) named->addItem(name(static_cast<NamedView>(i)));
  named->setToolTip("Named viewpoints along the object's axes, and from where it was scanned");
  connect(named, QOverload<int>::of(&QComboBox::activated), this, [this, named](int i) {
    if (i > 0) hooks_.named(static_cast<NamedView>(i - 1));
    named->setCurrentIndex(0);
  });
  row->addWidget(named);
  row->addStretch(1);
  one_ = add_button(OperatorAction::layout_one, "1", true);
  three_ = add_button(OperatorAction::layout_one_and_three, "1+3", true);
  four_ = add_button(OperatorAction::layout_two_by_two, "2×2", true);
  row->addSpacing(scaled(6));
  follow_ = add_button(OperatorAction::follow_harvester, "Follow", true);
  flip_ = add_button(OperatorAction::flip_harvester, "Flip", true);
  add_button(OperatorAction::reset_view, "Reset", false);
}

QDoubleSpinBox* ViewStrip::add_box(const QString& text, double low, double high, const QString& suffix,
                                   const QString& tip) {
  auto* label = new QLabel(text, this);
  label->setObjectName("quiet");
  auto* box = new QDoubleSpinBox(this);
  box->setRange(low, high);
  box->setDecimals(0);
  box->setSingleStep(5);
  box->setSuffix(suffix);
  box->setToolTip(tip);
  box->setKeyboardTracking(false);
  box->setFixedWidth(scaled(68));
  layout()->addWidget(label);
  layout()->addWidget(box);
  connect(box, QOverload<double>::of(&QDoubleSpinBox::valueChanged), this, [this] { changed(); });
  return box;
}

QPushButton* ViewStrip::add_button(OperatorAction action, const QString& text, bool checkable) {
  auto* button = new QPushButton(text, this);
  button->setObjectName("small");
  button->setCheckable(checkable);
  button->setFocusPolicy(Qt::TabFocus);
  button->setToolTip(tooltip(action));
  connect(button, &QPushButton::clicked, this, [this, action] { hooks_.act(action); });
  layout()->addWidget(button);
  return button;
}

void ViewStrip::changed() {
  ViewPose pose = pose_;
  pose.azimuth = radians_from_degrees(azimuth_->value());
  pose.elevation = radians_from_degrees(elevation_->value());
  pose.roll = radians_from_degrees(roll_->value());
  pose.distance = distance_->value();
  hooks_.look(pose);
}

void ViewStrip::show_pose(const ViewPose& pose, ViewLayout layout, bool following, bool flipped) {
  pose_ = pose;
  const auto put = [](QDoubleSpinBox* box, double value) {
    const QSignalBlocker quiet(box);
    if (!box->hasFocus()) box->setValue(value);
  };
  put(azimuth_, degrees_from_radians(pose.azimuth));
  put(elevation_, degrees_from_radians(pose.elevation));
  put(roll_, degrees_from_radians(pose.roll));
  put(distance_, pose.distance);
  one_->setChecked(layout == ViewLayout::one);
  three_->setChecked(layout == ViewLayout::one_and_three);
  four_->setChecked(layout == ViewLayout::two_by_two);
  follow_->setChecked(following);
  flip_->setChecked(flipped);
}

}  // namespace linescope
