// The buttons of the thesis's form, the moment the window is in, and what this program is not for.
#pragma once

#include <QFrame>
#include <functional>
#include <map>

#include "viewer/panel/operator_action.hpp"

class QPushButton;

namespace linescope {

/// What the window is for right now.
enum class Moment : std::uint8_t { scan, surface, navigate };
const char* name(Moment moment);

class TopBar : public QFrame {
 public:
  TopBar(std::function<void(OperatorAction)> act, QWidget* parent);

  void show_moment(Moment moment);
  /// `file`: a file is shown, the first button goes back to the daemon.
  void show_scanning(bool scanning, bool attached, bool file);

  QPushButton* button(OperatorAction action) const { return buttons_.at(action); }
  const std::map<OperatorAction, QPushButton*>& buttons() const { return buttons_; }

 private:
  QPushButton* add(OperatorAction action, const QString& text, bool checkable);

  std::function<void(OperatorAction)> act_;
  std::map<OperatorAction, QPushButton*> buttons_;
};

}  // namespace linescope
