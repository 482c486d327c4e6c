// Building blocks of the pages on the right: headings, rows of name and value.
#pragma once

#include <QLabel>
#include <QVBoxLayout>
#include <QWidget>

#include "viewer/panel/status_card.hpp"
#include "viewer/panel/theme.hpp"

namespace linescope {

class SidePage : public QWidget {
 public:
  explicit SidePage(QWidget* parent) : QWidget(parent), column_(new QVBoxLayout(this)) {
    setObjectName("page");
    column_->setContentsMargins(0, 0, 0, 0);
    column_->setSpacing(scaled(7));
  }

 protected:
  void add_heading(const QString& text) {
    auto* label = new QLabel(text.toUpper(), this);
    label->setObjectName("head");
    column_->addWidget(label);
  }
  /// "name ........ value"; the value is elided and tells all as its tooltip.
  ElidedLabel* add_row(const QString& name) {
    auto* row = new QHBoxLayout;
    auto* label = new QLabel(name, this);
    label->setFixedWidth(scaled(92));
    auto* value = new ElidedLabel(this);
    row->addWidget(label);
    row->addWidget(value, 1);
    column_->addLayout(row);
    return value;
  }

  static QString text_of(const Readout& readout) {
    if (!readout.blank()) return QString::fromStdString(readout.text);
    return QStringLiteral("– –  ") + QString::fromStdString(readout.reason);
  }

  QVBoxLayout* column_;
};

}  // namespace linescope
