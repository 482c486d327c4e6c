// The harvester as a tube with its tip, the surface normal as an arrow. Held frame, mm.
#pragma once

#include <vtkActor.h>
#include <vtkNew.h>
#include <vtkProp.h>

#include <Eigen/Core>
#include <functional>
#include <optional>

namespace linescope {

/// How a thing is to be drawn: not at all, as it is, or as a ghost at its last known place.
enum class Presence : std::uint8_t { absent, present, ghost };

struct GuidanceInput {
  Presence harvester = Presence::absent;
  Eigen::Vector3d tip{0, 0, 0}, axis{0, 0, 1};  ///< axis: unit, from the tip to the handle
  bool normal = false;
  Eigen::Vector3d foot{0, 0, 0}, normal_direction{0, 0, 1};
  bool on_target = false;
};

class GuidanceLayer {
 public:
  /// `add_tube` puts an actor into every view that does not look along it, `add_actor` into every view.
  GuidanceLayer(const std::function<void(vtkProp*)>& add_actor,
                const std::function<void(vtkProp*)>& add_tube);

  /// Lets the tube be looked through, for a view from its handle.
  void see_through(bool on) { see_through_ = on; }

  void set(const GuidanceInput& input);
  bool refresh() { return std::exchange(dirty_, false); }

  /// What is visible, for tests and for the displayed state.
  bool harvester_visible() const { return tube_->GetVisibility() != 0; }
  bool harvester_ghosted() const;
  bool normal_visible() const { return arrow_->GetVisibility() != 0; }

 private:
  void set_harvester(const GuidanceInput& input);
  void set_normal(const GuidanceInput& input);

  vtkNew<vtkActor> tube_, tip_, axis_line_, arrow_, foot_;
  bool dirty_ = true, see_through_ = false;
};

}  // namespace linescope
