// What the operator marked on the surface: the ends of a measured distance, the region of an evaluation.
// Held frame, mm.
#pragma once

#include <vtkActor.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkProp.h>
#include <vtkSphereSource.h>

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

namespace linescope {

struct MarkedRegion {
  Eigen::Vector3d centre{0, 0, 0};
  double radius = 5;  ///< mm
};

class MarkLayer {
 public:
  /// `add_actor` puts an actor into every view.
  explicit MarkLayer(const std::function<void(vtkProp*)>& add_actor);

  /// No, one or two ends; two are joined by a line.
  void set_distance(const std::vector<Eigen::Vector3d>& ends);
  void set_region(const std::optional<MarkedRegion>& region);
  bool refresh() { return std::exchange(dirty_, false); }

  bool distance_visible() const { return ends_->GetVisibility() != 0; }
  bool region_visible() const { return ball_->GetVisibility() != 0; }

 private:
  vtkNew<vtkPolyData> ends_data_;
  vtkNew<vtkActor> ends_, ball_;
  vtkNew<vtkSphereSource> ball_source_;
  bool dirty_ = false;
};

}  // namespace linescope
