// Looking along the harvester: where the handle leans against the normal, with the two signed tilts.
#pragma once

#include <QWidget>
#include <optional>

namespace linescope {

struct BullseyeReading {
  double right_deg =
      0;  ///< positive: the handle leans to the right of the normal, as the view along the harvester shows it
  double up_deg = 0;
  double tolerance_deg = 3;
};

class Bullseye : public QWidget {
 public:
  explicit Bullseye(QWidget* parent = nullptr);
  /// Nothing: blank.
  void show_reading(const std::optional<BullseyeReading>& reading);

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  std::optional<BullseyeReading> reading_;
};

}  // namespace linescope
