// Renders what the camera sees: white light of the endoscope's LED, the laser's line, what disturbs both, the
// sensor.
//
// Backwards ray casting: each pixel's ray is followed to the surface, and the light there is asked for. White
// light changes slowly, so it is cast on a grid of every fourth pixel and filled in between; near the line
// every pixel is cast, and everywhere when something is printed on the surface (a calibration board). During
// one exposure the surface is taken as its tangent plane at the pixel's hit (a hand moves it by some 0.2 mm:
// an error of about a micrometre on a knee), so that one cast serves all instants. One thread; nothing is
// allocated per picture once the first is done.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "acquire/twin/disturbances.hpp"
#include "acquire/twin/image_sensor.hpp"
#include "acquire/twin/laser_light.hpp"
#include "acquire/twin/phantom.hpp"
#include "acquire/twin/speckle.hpp"
#include "acquire/twin/tissue.hpp"
#include "acquire/twin/twin_options.hpp"
#include "acquire/twin/view_rays.hpp"
#include "common/rigid_transform.hpp"

namespace linescope::twin {

/// The camera against the phantom at one instant of the exposure.
struct Glance {
  Rigid<PhantomFrame, CameraCv> phantom_from_camera;
  double seconds = 0;
};

class Renderer {
 public:
  /// `options` valid; `phantom` and `sheet` outlive the renderer.
  Renderer(const TwinOptions& options, const Phantom& phantom, const LaserSheet& sheet);

  /// `glances`: the instants of the exposure, in order, at least one; the middle one lights the white image.
  /// `index`: the picture's number.
  void render(const std::vector<Glance>& glances, std::uint64_t index, cv::Mat& bgr);

 private:
  struct View {
    Eigen::Matrix3d rotation;  ///< phantom from camera
    Eigen::Vector3d eye;
  };
  /// An instant of the exposure against the middle one.
  struct Shift {
    Eigen::Matrix3d rotation;  ///< middle camera from this camera
    Eigen::Vector3d eye;
  };
  struct Seen {
    bool hit = false;
    Eigen::Vector3d point;   ///< camera's frame
    Eigen::Vector3d normal;  ///< camera's frame
  };
  struct Node {
    Seen seen;
    SheetPlace sheet;
    Eigen::Vector3d white;
  };

  void take_views(const std::vector<Glance>& glances);
  Seen look(const ViewRay& ray) const;
  bool shaded(const Seen& seen, const Eigen::Vector3d& light_direction) const;
  Eigen::Vector3d white_light(const Seen& seen) const;
  double laser_level(const ViewRay& ray, const Seen& seen) const;
  double level_at(const Shift& shift, const ViewRay& ray, const Seen& seen) const;

  void cast_grid();
  void fill_white();
  void fill_white_cell(int i, int j);
  double printed(int u, int v, const Seen& seen) const;
  void print_pattern();
  bool near_line(int i, int j) const;
  void add_line();
  void add_line_cell(int i, int j);

  const Node& node(int i, int j) const { return grid_[static_cast<std::size_t>(j * columns_ + i)]; }
  int pixel_u(int i) const;
  int pixel_v(int j) const;

  TwinOptions options_;
  const Phantom& phantom_;
  LaserLight laser_;
  Tissue tissue_;
  Disturbances disturbances_;
  ImageSensor sensor_;
  RayTable rays_;
  int columns_, rows_;

  // Of the picture in work.
  View middle_{};
  double seconds_ = 0;
  std::vector<Shift> shifts_;
  double most_shift_ = 0;  ///< rough bound of how far the line moves on the surface during the exposure, mm
  std::uint64_t index_ = 0;
  std::vector<Node> grid_;
  LightImage light_;
};

}  // namespace linescope::twin
