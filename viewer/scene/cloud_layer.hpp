// The measured points. Drawn in blocks, so that a growing scan uploads its newest block only, and thinned
// evenly when there are more than can be drawn in time (software rendering: about 0.5 microseconds per
// point).
#pragma once

#include <vtkActor.h>
#include <vtkFloatArray.h>
#include <vtkLookupTable.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkSmartPointer.h>

#include <functional>
#include <vector>

#include "viewer/scene/colour_scale.hpp"
#include "viewer/view_state.hpp"

namespace linescope {

class CloudLayer {
 public:
  /// `add_actor` puts an actor into every view.
  explicit CloudLayer(std::function<void(vtkProp*)> add_actor);

  void clear();
  void add(const HeldLine& line);
  /// At most this many points are drawn; the rest is thinned, every n-th point staying.
  void set_budget(std::size_t points);
  void show(bool visible);
  void colour_by(ColourBy what, const Eigen::Vector3d& outward);

  std::size_t drawn() const { return kept_.size(); }
  std::size_t received() const { return received_; }
  /// Every how many-th point is drawn.
  std::size_t thinning() const { return stride_; }
  /// The points drawn, for picking and for framing.
  const std::vector<Eigen::Vector3f>& points() const { return positions_; }
  /// Mean direction from the points to the camera that saw them; unit.
  Eigen::Vector3d outward() const;

  /// Brings the actors up to date; true when something changed since the last call.
  bool refresh();

 private:
  struct Block {
    vtkNew<vtkPoints> points;
    vtkNew<vtkFloatArray> scalars;
    vtkNew<vtkPolyData> data;
    vtkNew<vtkPolyDataMapper> mapper;
    vtkNew<vtkActor> actor;
  };
  struct Kept {
    float deviation, seconds;
  };

  Block& block(std::size_t number);
  void fill(std::size_t number);
  void fill_newest();
  void thin();
  float value(std::size_t i) const;
  void apply_colours();

  std::function<void(vtkProp*)> add_actor_;
  std::vector<std::unique_ptr<Block>> blocks_;
  Block newest_;
  std::vector<Eigen::Vector3f> newest_line_;
  std::vector<Eigen::Vector3f> positions_;
  std::vector<Kept> kept_;
  std::size_t received_ = 0, stride_ = 1, budget_ = 2'000'000, first_dirty_ = 0;
  Nanoseconds first_time_ = 0;
  Eigen::Vector3d outward_sum_{0, 0, 0};
  Eigen::Vector3d outward_{0, 0, 1};  ///< colouring by height
  ColourBy colour_ = ColourBy::plain;
  vtkSmartPointer<vtkLookupTable> scale_ = colour_scale();
  bool visible_ = true, dirty_ = true;
};

}  // namespace linescope
