// All that is drawn in three dimensions: the layers, and the views that show them. One render window, several
// views. Belongs to the display thread.
#pragma once

#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>

#include <array>
#include <memory>
#include <optional>

#include "viewer/scene/cloud_layer.hpp"
#include "viewer/scene/guidance_layer.hpp"
#include "viewer/scene/mark_layer.hpp"
#include "viewer/scene/mouse_style.hpp"
#include "viewer/scene/surface_layer.hpp"
#include "viewer/scene/view_overlay.hpp"
#include "viewer/scene/view_pose.hpp"

namespace linescope {

enum class View : std::uint8_t { free, along_x, along_y, along_z, along_harvester };
inline constexpr int kViews = 5;

enum class ViewLayout : std::uint8_t {
  one,            ///< the free view
  one_and_three,  ///< the free view, and along the object's three axes
  two_by_two,     ///< free, along the harvester, along x, along y
};

enum class NamedView : std::uint8_t { front, back, left, right, top, bottom, endoscope };
inline constexpr int kNamedViews = 7;
const char* name(NamedView view);

class Scene {
 public:
  /// `window` must outlive the scene.
  explicit Scene(vtkRenderWindow& window);
  ~Scene();

  CloudLayer& cloud() { return *cloud_; }
  SurfaceLayer& surface() { return *surface_; }
  GuidanceLayer& guidance() { return *guidance_; }
  MarkLayer& marks() { return *marks_; }
  MouseStyle& mouse() { return *mouse_; }

  void set_layout(ViewLayout layout);
  ViewLayout layout() const { return layout_; }
  /// The free view follows the harvester's axis, or is the operator's.
  void follow_harvester(bool follow);
  bool following() const { return follow_; }
  /// Which end of the tube the eye sits at in the view along the harvester.
  void flip_harvester_view();
  bool harvester_view_flipped() const { return flipped_; }
  /// Text and marker size relative to 96 dpi.
  void set_text_scale(double scale);
  void set_note(const std::string& note);

  void set_view_pose(const ViewPose& pose);
  ViewPose view_pose();
  void look_from(NamedView view);
  /// Frames what there is, seen from where it was scanned.
  void reset_view();

  /// What the harvester is at: drawn, and looked along.
  void set_guidance(const GuidanceInput& input);

  /// Brings everything up to date; true when a new picture is needed.
  bool refresh();
  void request_picture() { dirty_ = true; }

  vtkRenderer& renderer(View view) { return *renderers_[static_cast<std::size_t>(view)]; }
  /// Views in the present layout.
  std::vector<View> visible_views() const;
  /// Centre and radius of what is there, mm; radius 0: nothing.
  std::pair<Eigen::Vector3d, double> extent() const;

  /// The drawn point or mesh vertex nearest to the line of sight through a pixel of the free view, within
  /// `reach_px`, of those in front (within a millimetre in depth).
  std::optional<Eigen::Vector3d> pick(int x, int y, double reach_px = 6);

 private:
  template <class Visit>
  void each_pickable(const Visit& visit) const;
  void place_views();
  void aim_axis_views();
  void aim_harvester_view(vtkRenderer& renderer);
  void frame_first_time();
  Eigen::Vector3d long_axis() const;

  vtkRenderWindow& window_;
  std::array<vtkNew<vtkRenderer>, kViews> renderers_;
  std::array<std::unique_ptr<ViewOverlay>, kViews> overlays_;
  std::unique_ptr<CloudLayer> cloud_;
  std::unique_ptr<SurfaceLayer> surface_;
  std::unique_ptr<GuidanceLayer> guidance_;
  std::unique_ptr<MarkLayer> marks_;
  vtkNew<MouseStyle> mouse_;
  GuidanceInput guided_;
  ViewLayout layout_ = ViewLayout::one;
  bool follow_ = false, flipped_ = false, framed_ = false, operator_moved_ = false, dirty_ = true;
  double framed_radius_ = 0;
};

}  // namespace linescope
