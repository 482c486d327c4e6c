#include "acquire/twin/renderer.hpp"

#include <algorithm>
#include <cmath>

namespace linescope::twin {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kCell = 4;                       // px between grid nodes
constexpr double kFarthestWork = 40;           // mm; beyond it the line is too weak to care how far it moves
const Vector3d kLaserColour{0.16, 1.0, 0.10};  // of 532 nm in the camera's blue, green, red

constexpr int kGreen = 1;

int nodes_for(int pixels) {
  return (pixels + kCell - 2) / kCell + 1;
}

ViewRays view_rays(const TwinOptions& options) {
  return {options.instrument.lens, options.optics.port, options.optics.prism.medium_index};
}

}  // namespace

Renderer::Renderer(const TwinOptions& options, const Phantom& phantom, const LaserSheet& sheet)
    : options_(options),
      phantom_(phantom),
      laser_(options.seed, sheet, options.optics),
      tissue_(options.seed, options.optics.light, options.optics.trouble),
      disturbances_(options.seed, options.optics.trouble),
      sensor_(options.seed, options.optics.sensor),
      rays_(view_rays(options), options.instrument.lens.width, options.instrument.lens.height),
      columns_(nodes_for(options.instrument.lens.width)),
      rows_(nodes_for(options.instrument.lens.height)),
      grid_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {}

int Renderer::pixel_u(int i) const {
  return std::min(i * kCell, options_.instrument.lens.width - 1);
}
int Renderer::pixel_v(int j) const {
  return std::min(j * kCell, options_.instrument.lens.height - 1);
}

void Renderer::take_views(const std::vector<Glance>& glances) {
  const Glance& middle = glances[glances.size() / 2];
  middle_ = {middle.phantom_from_camera.rotation().toRotationMatrix(),
             middle.phantom_from_camera.translation()};
  seconds_ = middle.seconds;
  shifts_.clear();
  most_shift_ = 0;
  for (const Glance& glance : glances) {
    const auto relative = middle.phantom_from_camera.inverse() * glance.phantom_from_camera;
    shifts_.push_back({relative.rotation().toRotationMatrix(), relative.translation()});
    const double turn = relative.rotation().angularDistance(Eigen::Quaterniond::Identity());
    most_shift_ = std::max(most_shift_, relative.translation().norm() + turn * kFarthestWork);
  }
}

Renderer::Seen Renderer::look(const ViewRay& ray) const {
  Seen seen;
  if (!ray.lit()) return seen;
  Hit hit;
  const Vector3d from = middle_.rotation * ray.origin + middle_.eye, way = middle_.rotation * ray.direction;
  if (!phantom_.cast(from, way, hit)) return seen;
  seen.hit = true;
  seen.point = ray.origin + hit.distance * ray.direction;
  seen.normal = middle_.rotation.transpose() * hit.normal;
  return seen;
}

bool Renderer::shaded(const Seen& seen, const Vector3d& light_direction) const {
  if (phantom_.convex()) return false;
  constexpr double kLift = 1e-3;  // mm off the surface, so that it does not shade itself
  Hit blocker;
  return phantom_.cast(middle_.rotation * (seen.point + kLift * seen.normal) + middle_.eye,
                       middle_.rotation * -light_direction, blocker);
}

// The LEDs sit around the lens: light comes from where the camera is.
Vector3d Renderer::white_light(const Seen& seen) const {
  const LightOptions& light = options_.optics.light;
  if (!seen.hit || !(light.led_brightness > 0)) return Vector3d::Zero();
  const double distance = seen.point.norm();
  const double cosine = std::max(0.0, -seen.normal.dot(seen.point) / distance);
  const double falloff = light.reference_distance_mm / distance;
  const double level = light.led_brightness * falloff * falloff * cosine;
  if (phantom_.paint()) return Vector3d::Constant(level);  // the pattern comes later, pixel by pixel
  return level * tissue_.albedo(middle_.rotation * seen.point + middle_.eye);
}

double Renderer::level_at(const Shift& shift, const ViewRay& ray, const Seen& seen) const {
  const Vector3d from = shift.rotation * ray.origin + shift.eye, way = shift.rotation * ray.direction;
  const double along = seen.normal.dot(seen.point - from) / seen.normal.dot(way);
  const SheetPlace place = laser_.sheet().at(ray.origin + along * ray.direction);
  return laser_.level(place, shift.rotation.transpose() * seen.normal, seconds_);
}

double Renderer::laser_level(const ViewRay& ray, const Seen& seen) const {
  const SheetPlace place = laser_.sheet().at(seen.point);
  if (!laser_.touches(place, most_shift_)) return 0;
  double sum = 0;
  if (shifts_.size() == 1) sum = laser_.level(place, seen.normal, seconds_);
  if (shifts_.size() > 1) {
    for (const Shift& shift : shifts_) sum += level_at(shift, ray, seen);
  }
  if (!(sum > 0) || shaded(seen, place.direction)) return 0;
  return sum / static_cast<double>(shifts_.size()) * laser_.passing(place.fan_angle, seconds_);
}

void Renderer::cast_grid() {
  for (int j = 0; j < rows_; ++j) {
    for (int i = 0; i < columns_; ++i) {
      Node& here = grid_[static_cast<std::size_t>(j * columns_ + i)];
      here.seen = look(rays_.at(pixel_u(i), pixel_v(j)));
      if (here.seen.hit) here.sheet = laser_.sheet().at(here.seen.point);
      here.white = white_light(here.seen);
    }
  }
}

void Renderer::fill_white() {
  for (int j = 0; j + 1 < rows_; ++j) {
    for (int i = 0; i + 1 < columns_; ++i) fill_white_cell(i, j);
  }
}

void Renderer::fill_white_cell(int i, int j) {
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
          hits == 4 ? Vector3d(left + fu * (right - left)) : white_light(look(rays_.at(u, v)));
      auto& pixel = light_.at(u, v);
      for (int k = 0; k < 3; ++k) pixel[static_cast<std::size_t>(k)] = static_cast<float>(white[k]);
    }
  }
}

// What the paint makes of the pixel's light. The surface is its tangent plane from one pixel to the next.
double Renderer::printed(int u, int v, const Seen& seen) const {
  const auto way_to = [&](int du, int dv) {
    const ViewRay& ray = rays_.at(u + du, v + dv);
    if (!ray.lit()) return Vector3d(Vector3d::Zero());
    const double along = seen.normal.dot(seen.point - ray.origin) / seen.normal.dot(ray.direction);
    return Vector3d(middle_.rotation * (ray.origin + along * ray.direction - seen.point));
  };
  const int right = u + 1 < options_.instrument.lens.width ? 1 : -1;
  const int down = v + 1 < options_.instrument.lens.height ? 1 : -1;
  return phantom_.paint()->reflectance(middle_.rotation * seen.point + middle_.eye, way_to(right, 0),
                                       way_to(0, down));
}

void Renderer::print_pattern() {
  if (!phantom_.paint()) return;
  for (int v = 0; v < options_.instrument.lens.height; ++v) {
    for (int u = 0; u < options_.instrument.lens.width; ++u) {
      const Seen seen = look(rays_.at(u, v));
      if (!seen.hit) continue;
      const auto share = static_cast<float>(printed(u, v, seen));
      for (float& level : light_.at(u, v)) level *= share;
    }
  }
}

// The line may cross a cell whose corners are all off it: the offset between corners tells how far to be
// careful.
bool Renderer::near_line(int i, int j) const {
  double lowest = 1e300, highest = -1e300;
  LaserLight::Band band{0, 0};
  for (const Node* corner : {&node(i, j), &node(i + 1, j), &node(i, j + 1), &node(i + 1, j + 1)}) {
    if (!corner->seen.hit) continue;
    lowest = std::min(lowest, corner->sheet.offset);
    highest = std::max(highest, corner->sheet.offset);
    const LaserLight::Band here = laser_.band(corner->sheet.distance);
    band = {std::min(band.low, here.low), std::max(band.high, here.high)};
  }
  if (lowest > highest) return false;
  const double care = 0.5 * (highest - lowest) + most_shift_;
  return lowest - care <= band.high && highest + care >= band.low;
}

void Renderer::add_line() {
  for (int j = 0; j + 1 < rows_; ++j) {
    for (int i = 0; i + 1 < columns_; ++i) {
      if (near_line(i, j)) add_line_cell(i, j);
    }
  }
}

// Cells own their left and upper edge; the picture's last column and row belong to the last cells.
void Renderer::add_line_cell(int i, int j) {
  const int u1 = pixel_u(i + 1) + (i + 2 == columns_), v1 = pixel_v(j + 1) + (j + 2 == rows_);
  for (int v = pixel_v(j); v < v1; ++v) {
    for (int u = pixel_u(i); u < u1; ++u) {
      const ViewRay& ray = rays_.at(u, v);
      const Seen seen = look(ray);
      if (!seen.hit) continue;
      const double level = laser_level(ray, seen);
      if (!(level > 0)) continue;
      const double grain = speckle_factor(options_.optics.line, options_.seed, index_, u, v);
      const double back = phantom_.paint()
                              ? printed(u, v, seen)
                              : tissue_.albedo(middle_.rotation * seen.point + middle_.eye)[kGreen];
      auto& pixel = light_.at(u, v);
      for (int k = 0; k < 3; ++k) {
        pixel[static_cast<std::size_t>(k)] += static_cast<float>(level * back * grain * kLaserColour[k]);
      }
    }
  }
}

void Renderer::render(const std::vector<Glance>& glances, std::uint64_t index, cv::Mat& bgr) {
  light_.clear(options_.instrument.lens.width, options_.instrument.lens.height);
  index_ = index;
  take_views(glances);
  cast_grid();
  fill_white();
  print_pattern();
  add_line();
  disturbances_.add(light_, seconds_);
  sensor_.expose(light_, index, bgr);
}

}  // namespace linescope::twin
