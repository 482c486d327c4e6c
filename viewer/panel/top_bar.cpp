#include "viewer/panel/top_bar.hpp"

#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>

#include "viewer/panel/theme.hpp"

namespace linescope {

const char* name(Moment moment) {
  switch (moment) {
    case Moment::scan:
      return "scan";
    case Moment::surface:
      return "surface";
    case Moment::navigate:
      return "navigate";
  }
  return "?";
}

TopBar::TopBar(std::function<void(OperatorAction)> act, QWidget* parent)
    : QFrame(parent), act_(std::move(act)) {
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(scaled(10), scaled(8), scaled(10), scaled(6));
  row->setSpacing(scaled(8));
  row->addWidget(add(OperatorAction::scan, "Scan", true));
  row->addWidget(add(OperatorAction::clear, "Clear", false));
  row->addWidget(add(OperatorAction::undo_sweep, "Undo", false));
  row->addSpacing(scaled(20));
  row->addWidget(add(OperatorAction::surface, "Surface", true));
  row->addWidget(add(OperatorAction::navigate, "Navi", true));
  row->addStretch(1);
  auto* disclaimer = new QLabel("Not for clinical use", this);
  disclaimer->setObjectName("disclaimer");
  disclaimer->setToolTip("A research system. It is not a medical device.");
  row->addWidget(disclaimer);
  row->addSpacing(scaled(8));
  row->addWidget(add(OperatorAction::save_session, "Save", false));
  row->addWidget(add(OperatorAction::open_session, "Open", false));
  row->addWidget(add(OperatorAction::diagnostics, "Diagnostics", false));
  row->addWidget(add(OperatorAction::shortcuts, "Keys", false));
  for (const auto small : {OperatorAction::save_session, OperatorAction::open_session,
                           OperatorAction::diagnostics, OperatorAction::shortcuts})
    buttons_[small]->setObjectName("small");
}

QPushButton* TopBar::add(OperatorAction action, const QString& text, bool checkable) {
  auto* made = new QPushButton(text, this);
  made->setObjectName("action");
  made->setCheckable(checkable);
  made->setToolTip(tooltip(action));
  made->setAccessibleName(text);
  made->setFocusPolicy(Qt::TabFocus);  // a click must not take the space bar away from Scan
  connect(made, &QPushButton::clicked, this, [this, action] { act_(action); });
  buttons_[action] = made;
  return made;
}

void TopBar::show_moment(Moment moment) {
  buttons_[OperatorAction::surface]->setChecked(moment == Moment::surface);
  buttons_[OperatorAction::navigate]->setChecked(moment == Moment::navigate);
}

void TopBar::show_scanning(bool scanning, bool attached, bool file) {
  QPushButton& scan = *buttons_[OperatorAction::scan];
  scan.setChecked(scanning);
  scan.setText(file ? "Live" : scanning ? "Stop" : "Scan");
  scan.setEnabled(attached || file);
  buttons_[OperatorAction::undo_sweep]->setEnabled(attached);
}

}  // namespace linescope
