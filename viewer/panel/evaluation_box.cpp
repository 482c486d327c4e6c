#include "viewer/panel/evaluation_box.hpp"

#include <fmt/format.h>

#include <QComboBox>
#include <QDoubleSpinBox>
#include <QPushButton>

#include "viewer/panel/operator_action.hpp"

namespace linescope {
namespace {

QDoubleSpinBox* millimetres(QWidget* parent, double low, double high, int decimals, const char* tip) {
  auto* box = new QDoubleSpinBox(parent);
  box->setRange(low, high);
  box->setDecimals(decimals);
  box->setSuffix(" mm");
  box->setKeyboardTracking(false);
  box->setToolTip(tip);
  return box;
}

}  // namespace

EvaluationBox::EvaluationBox(Hooks hooks, QWidget* parent) : SidePage(parent), hooks_(std::move(hooks)) {
  add_heading("Precision evaluation");
  add_choices();
  diameter_ = add_row("Diameter");
  distances_ = add_row("Deviation");
  clear_result();
}

void EvaluationBox::add_choices() {
  shape_ = new QComboBox(this);
  for (const Shape shape : kShapes) {
    QString text = name(shape);
    text[0] = text[0].toUpper();
    shape_->addItem(text, static_cast<int>(shape));
  }
  shape_->setCurrentIndex(static_cast<int>(Shape::cylinder));
  shape_->setToolTip(tooltip(OperatorAction::next_shape));
  nominal_ = millimetres(this, 0, 500, 2, "Nominal diameter: what it should be; 0 when it is not known");
  nominal_->setSpecialValueText("nominal –");
  nominal_->setPrefix("⌀ ");
  auto* first = new QHBoxLayout;
  first->addWidget(shape_, 1);
  first->addWidget(nominal_, 1);
  column_->addLayout(first);
  region_ = new QPushButton("All points", this);
  region_->setCheckable(true);
  region_->setObjectName("small");
  region_->setFocusPolicy(Qt::TabFocus);
  region_->setToolTip(tooltip(OperatorAction::region));
  radius_ = millimetres(this, 0.5, 100, 1, "Radius of the region");
  radius_->setValue(5);
  radius_->setPrefix("r ");
  evaluate_ = new QPushButton("Evaluate", this);
  evaluate_->setObjectName("small");
  evaluate_->setFocusPolicy(Qt::TabFocus);
  evaluate_->setToolTip(tooltip(OperatorAction::evaluate));
  auto* second = new QHBoxLayout;
  second->addWidget(region_, 3);
  second->addWidget(radius_, 3);
  second->addWidget(evaluate_, 3);
  column_->addLayout(second);
  connect(region_, &QPushButton::clicked, this, [this] { hooks_.region(); });
  connect(evaluate_, &QPushButton::clicked, this, [this] { hooks_.evaluate(); });
  connect(radius_, QOverload<double>::of(&QDoubleSpinBox::valueChanged), this, [this] { hooks_.changed(); });
}

EvaluationRequest EvaluationBox::request() const {
  EvaluationRequest r;
  r.shape = static_cast<Shape>(shape_->currentData().toInt());
  r.nominal = nominal_->value();
  r.region.all = !centre_.has_value();
  r.region.centre = centre_.value_or(Eigen::Vector3d::Zero());
  r.region.radius = radius_->value();
  return r;
}

void EvaluationBox::set_request(const EvaluationRequest& r) {
  shape_->setCurrentIndex(shape_->findData(static_cast<int>(r.shape)));
  nominal_->setValue(r.nominal);
  radius_->setValue(r.region.radius);
}

void EvaluationBox::next_shape() {
  shape_->setCurrentIndex((shape_->currentIndex() + 1) % shape_->count());
}

void EvaluationBox::set_region(const std::optional<Eigen::Vector3d>& centre) {
  centre_ = centre;
  region_->setChecked(centre.has_value());
  region_->setText(centre ? "Region" : "All points");
  hooks_.changed();
}

void EvaluationBox::clear_result() {
  diameter_->set_text(QStringLiteral("– –"));
  distances_->set_text(QStringLiteral("– –"));
}

void EvaluationBox::show_hint(const QString& hint) {
  clear_result();
  distances_->set_text(hint);
}

void EvaluationBox::show_result(const Result<ShapeEvaluation>& result) {
  if (!result) return show_hint(QString::fromStdString(result.error().message));
  const ShapeEvaluation& e = *result;
  std::string diameter =
      e.has_diameter() ? fmt::format("{:.2f} mm", e.diameter) : std::string("a plane has none");
  if (e.has_difference())
    diameter += fmt::format("   {:+.2f} mm, {:+.1f} %", e.difference(), e.difference_percent());
  diameter_->set_text(QString::fromStdString(diameter));
  distances_->set_text(QString::fromStdString(
      fmt::format("{:.2f} ± {:.2f} mm, max {:.2f}", e.mean_size, e.deviation, e.maximum)));
  distances_->setToolTip(QString::fromStdString(sentence(e)));
}

QString EvaluationBox::text() const {
  return diameter_->text() + " | " + distances_->text();
}

}  // namespace linescope
