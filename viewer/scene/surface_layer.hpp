// The reconstructed surface and the grid behind it.
#pragma once

#include <vtkActor.h>
#include <vtkLookupTable.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProp.h>
#include <vtkSmartPointer.h>

#include <functional>

#include "viewer/scene/colour_scale.hpp"
#include "viewer/view_state.hpp"

namespace linescope {

enum class SurfaceStyle : std::uint8_t { hidden, surface, wireframe };

class SurfaceLayer {
 public:
  explicit SurfaceLayer(const std::function<void(vtkProp*)>& add_actor);

  void set(const SurfaceView& view);
  void show(SurfaceStyle style);
  bool visible() const { return actor_->GetVisibility() != 0; }
  void show_grid(bool visible);
  /// Shading by the mesh's vertex normals (thesis Fig 4.11) or flat by triangle.
  void use_normals(bool smooth);
  void colour_by(ColourBy what, const Eigen::Vector3d& outward);

  std::size_t triangles() const { return triangles_; }
  std::size_t filled_triangles() const {
    return filled_;
  }  ///< of these: close holes, in a colour of their own
  std::size_t grid_points() const { return grid_count_; }
  const std::shared_ptr<const TriangleMesh>& mesh() const { return mesh_; }

  bool refresh();

 private:
  void fill_mesh();
  void fill_grid();
  void fill_scalars();

  std::shared_ptr<const TriangleMesh> mesh_;
  std::shared_ptr<const std::vector<Eigen::Vector3f>> grid_;
  vtkNew<vtkPolyData> data_, filled_data_, grid_data_;
  vtkNew<vtkPolyDataMapper> mapper_, filled_mapper_, grid_mapper_;
  vtkNew<vtkActor> actor_, filled_actor_, grid_actor_;
  vtkSmartPointer<vtkLookupTable> scale_ = colour_scale();
  ColourBy colour_ = ColourBy::plain;
  Eigen::Vector3d outward_{0, 0, 1};
  std::size_t triangles_ = 0, filled_ = 0, grid_count_ = 0;
  bool new_data_ = false, dirty_ = true;
};

}  // namespace linescope
