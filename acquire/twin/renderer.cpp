#include "acquire/twin/renderer.hpp"

#include <algorithm>
#include <cmath>

#include "acquire/twin/speckle.hpp"

namespace linescope::twin {
namespace {

using Eigen::Vector3d;

constexpr int kCell = 4;                       // px between grid nodes
const Vector3d kLaserColour{0.16, 1.0, 0.10};  // of 532 nm in the camera's blue, green, red

int nodes_for(int pixels) {
  return (pixels + kCell - 2) / kCell + 1;
}

}  // namespace

Renderer::Renderer(const TwinOptions& options, const Phantom& phantom, const LaserSheet& sheet)
    : options_(options),
      phantom_(phantom),
      laser_(options.seed, sheet, options.optics),
      tissue_(options.seed, options.optics.light, options.optics.trouble),
      disturbances_(options.seed, options.optics.trouble),
      sensor_(options.seed, options.optics.sensor),
      view_rays_(options.instrument.lens, options.optics.port, options.optics.prism.medium_index),
      rays_(view_rays_, options.instrument.lens.width, options.instrument.lens.height),
      columns_(nodes_for(options.instrument.lens.width)),
      rows_(nodes_for(options.instrument.lens.height)),
      grid_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {}

int Renderer::pixel_u(int i) const {
  return std::min(i * kCell, options_.instrument.lens.width - 1);
}
int Renderer::pixel_v(int j) const {
  return std::min(j * kCell, options_.instrument.lens.height - 1);
}

Renderer::View Renderer::view_of(const Glance& glance) {
  return {glance.phantom_from_camera.rotation().toRotationMatrix(), glance.phantom_from_camera.translation()};
}

Renderer::Seen Renderer::look(const View& view, const ViewRay& ray) const {
  Seen seen;
  if (!ray.lit()) return seen;
  Hit hit;
  if (!phantom_.cast(view.rotation * ray.origin + view.eye, view.rotation * ray.direction, hit)) return seen;
  seen.hit = true;
  seen.point = ray.origin + hit.distance * ray.direction;
  seen.normal = view.rotation.transpose() * hit.normal;
  return seen;
}

bool Renderer::shaded(const View& view, const Seen& seen, const Vector3d& light_direction) const {
  if (phantom_.convex()) return false;
  constexpr double kLift = 1e-3;  // mm off the surface, so that it does not shade itself
  Hit blocker;
  return phantom_.cast(view.rotation * (seen.point + kLift * seen.normal) + view.eye,
                       view.rotation * -light_direction, blocker);
}

// The LEDs sit around the lens: light comes from where the camera is.
Vector3d Renderer::white_light(const View& view, const Seen& seen) const {
  const LightOptions& light = options_.optics.light;
  if (!seen.hit || !(light.led_brightness > 0)) return Vector3d::Zero();
  const double distance = seen.point.norm();
  const double cosine = std::max(0.0, -seen.normal.dot(seen.point) / distance);
  const double falloff = light.reference_distance_mm / distance;
  return light.led_brightness * falloff * falloff * cosine *
         tissue_.albedo(view.rotation * seen.point + view.eye);
}

double Renderer::laser_level(const View& view, const Seen& seen, double seconds) const {
  const SheetPlace place = laser_.sheet().at(seen.point);
  const double level = laser_.level(place, seen.normal, seconds);
  if (!(level > 0) || shaded(view, seen, place.direction)) return 0;
  return level;
}

void Renderer::cast_grid(const View& view, bool with_white) {
  for (int j = 0; j < rows_; ++j) {
    for (int i = 0; i < columns_; ++i) {
      Node& here = grid_[static_cast<std::size_t>(j * columns_ + i)];
      here.seen = look(view, rays_.at(pixel_u(i), pixel_v(j)));
      if (here.seen.hit) here.sheet = laser_.sheet().at(here.seen.point);
      if (with_white) here.white = white_light(view, here.seen);
    }
  }
}

void Renderer::fill_white(const View& view) {
  for (int j = 0; j + 1 < rows_; ++j) {
    for (int i = 0; i + 1 < columns_; ++i) fill_white_cell(view, i, j);
  }
}

void Renderer::fill_white_cell(const View& view, int i, int j) {
  const Node &a = node(i, j), &b = node(i + 1, j), &c = node(i, j + 1), &d = node(i + 1, j + 1);
  const int hits = a.seen.hit + b.seen.hit + c.seen.hit + d.seen.hit;
  if (hits == 0) return;
  const int u0 = pixel_u(i), u1 = pixel_u(i + 1), v0 = pixel_v(j), v1 = pixel_v(j + 1);
  for (int v = v0; v <= v1; ++v) {
    const double fv = v1 > v0 ? static_cast<double>(v - v0) / (v1 - v0) : 0.0;
    const Vector3d left = a.white + fv * (c.white - a.white), right = b.white + fv * (d.white - b.white);
    for (int u = u0; u <= u1; ++u) {
      const double fu = u1 > u0 ? static_cast<double>(u - u0) / (u1 - u0) : 0.0;
      const Vector3d white =
          hits == 4 ? Vector3d(left + fu * (right - left)) : white_light(view, look(view, rays_.at(u, v)));
      auto& pixel = light_.at(u, v);
      for (int k = 0; k < 3; ++k) pixel[static_cast<std::size_t>(k)] = static_cast<float>(white[k]);
    }
  }
}

// The line may cross a cell whose corners are all off it: the offset between corners tells how far to be
// careful.
bool Renderer::near_line(int i, int j) const {
  double lowest = 1e300, highest = -1e300, reach = 0;
  for (const Node* corner : {&node(i, j), &node(i + 1, j), &node(i, j + 1), &node(i + 1, j + 1)}) {
    if (!corner->seen.hit) continue;
    lowest = std::min(lowest, corner->sheet.offset);
    highest = std::max(highest, corner->sheet.offset);
    reach = std::max(reach, laser_.reach(corner->sheet.distance));
  }
  if (lowest > highest) return false;
  const double care = reach + 0.5 * (highest - lowest);
  return lowest - care <= 0 && highest + care >= 0;
}

void Renderer::add_line(const View& view, double seconds, double share, std::uint64_t index) {
  for (int j = 0; j + 1 < rows_; ++j) {
    for (int i = 0; i + 1 < columns_; ++i) {
      if (near_line(i, j)) add_line_cell(view, i, j, seconds, share, index);
    }
  }
}

// Cells own their left and upper edge; the picture's last column and row belong to the last cells.
void Renderer::add_line_cell(const View& view, int i, int j, double seconds, double share,
                             std::uint64_t index) {
  const int u1 = pixel_u(i + 1) + (i + 2 == columns_), v1 = pixel_v(j + 1) + (j + 2 == rows_);
  for (int v = pixel_v(j); v < v1; ++v) {
    for (int u = pixel_u(i); u < u1; ++u) {
      const Seen seen = look(view, rays_.at(u, v));
      if (!seen.hit) continue;
      const double level = laser_level(view, seen, seconds);
      if (!(level > 0)) continue;
      const double grain = speckle_factor(options_.optics.line, options_.seed, index, u, v);
      auto& pixel = light_.at(u, v);
      for (int k = 0; k < 3; ++k) {
        pixel[static_cast<std::size_t>(k)] += static_cast<float>(share * level * grain * kLaserColour[k]);
      }
    }
  }
}

void Renderer::render(const std::vector<Glance>& glances, std::uint64_t index, cv::Mat& bgr) {
  light_.clear(options_.instrument.lens.width, options_.instrument.lens.height);
  const std::size_t middle = glances.size() / 2;
  const View middle_view = view_of(glances[middle]);
  cast_grid(middle_view, true);
  fill_white(middle_view);
  const double share = 1.0 / static_cast<double>(glances.size());
  for (std::size_t k = 0; k < glances.size(); ++k) {
    const View view = view_of(glances[k]);
    if (k != 0 || glances.size() > 1) cast_grid(view, false);
    add_line(view, glances[k].seconds, share, index);
  }
  disturbances_.add(light_, glances[middle].seconds);
  sensor_.expose(light_, index, bgr);
}

}  // namespace linescope::twin
