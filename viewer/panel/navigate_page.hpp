// The moment "Navigate": bullseye, tilts, distance, 95 % interval, tolerance and how long it was held.
#pragma once

#include <functional>
#include <optional>

#include "viewer/navigation_worker.hpp"
#include "viewer/panel/bullseye.hpp"
#include "viewer/panel/side_page.hpp"

class QCheckBox;
class QComboBox;
class QDoubleSpinBox;

namespace linescope {

class NavigatePage : public SidePage {
 public:
  NavigatePage(std::function<void(NormalChoice)> choose, NormalChoice choice, QWidget* parent);

  /// `tilts`: right and up, degrees; nothing when the angle is blank.
  void show_state(const AngleReadout& angle, const std::optional<BullseyeReading>& tilts,
                  const NavigationView& navigation);
  Tolerance tolerance() const;
  bool sound() const;
  void set_preferences(const Tolerance& tolerance, bool sound);

 private:
  void add_tolerance();
  void show_hold(const AngleReadout& angle);

  Bullseye* bullseye_;
  ElidedLabel *distance_, *depth_, *uncertainty_, *basis_, *held_;
  QDoubleSpinBox *angle_limit_, *distance_limit_;
  QComboBox* method_;
  QCheckBox* sound_;
  bool told_ = false;
};

}  // namespace linescope
