// The thesis's form "CamePos" as a strip below the views: azimuth, elevation, roll, distance, named views,
// layouts.
#pragma once

#include <QFrame>
#include <functional>

#include "viewer/panel/operator_action.hpp"
#include "viewer/scene/scene.hpp"

class QComboBox;
class QDoubleSpinBox;
class QPushButton;

namespace linescope {

class ViewStrip : public QFrame {
 public:
  struct Hooks {
    std::function<void(const ViewPose&)> look;
    std::function<void(NamedView)> named;
    std::function<void(OperatorAction)> act;
  };
  ViewStrip(Hooks hooks, QWidget* parent);

  /// What the camera shows now; a box being typed in is left alone.
  void show_pose(const ViewPose& pose, ViewLayout layout, bool following, bool flipped);

 private:
  QDoubleSpinBox* add_box(const QString& name, double low, double high, const QString& suffix,
                          const QString& tip);
  QPushButton* add_button(OperatorAction action, const QString& text, bool checkable);
  void changed();

  Hooks hooks_;
  ViewPose pose_;
  QDoubleSpinBox *azimuth_, *elevation_, *roll_, *distance_;
  QPushButton *one_, *three_, *four_, *follow_, *flip_;
};

}  // namespace linescope
