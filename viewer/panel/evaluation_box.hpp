// Precision evaluation, as in the thesis's main form: which shape, of which points, against which nominal
// value; and what came out.
#pragma once

#include <functional>
#include <optional>

#include "viewer/measure/shape_evaluation.hpp"
#include "viewer/panel/side_page.hpp"

class QComboBox;
class QDoubleSpinBox;
class QPushButton;

namespace linescope {

/// What the operator asked for.
struct EvaluationRequest {
  Shape shape = Shape::cylinder;
  Region region;
  double nominal = 0;  ///< diameter, mm; 0: none
};

class EvaluationBox : public SidePage {
 public:
  struct Hooks {
    std::function<void()> evaluate;  ///< as request() says
    std::function<void()> region;    ///< whole scan, or pick the middle of a region
    std::function<void()> changed;   ///< the region, to be drawn
  };
  EvaluationBox(Hooks hooks, QWidget* parent);

  EvaluationRequest request() const;
  void set_request(const EvaluationRequest& request);
  void next_shape();
  /// Nothing: all points.
  void set_region(const std::optional<Eigen::Vector3d>& centre);

  void show_result(const Result<ShapeEvaluation>& result);
  /// A word on what is to be done next, in place of the result.
  void show_hint(const QString& hint);
  void clear_result();
  /// As shown: the rows joined, for scripts and tests.
  QString text() const;

 private:
  void add_choices();

  Hooks hooks_;
  std::optional<Eigen::Vector3d> centre_;
  QComboBox* shape_;
  QDoubleSpinBox *nominal_, *radius_;
  QPushButton *region_, *evaluate_;
  ElidedLabel *diameter_, *distances_;
};

}  // namespace linescope
