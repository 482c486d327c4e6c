#include "common/camera_model.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>

namespace linescope {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

struct Distorted {
  Vector2d xy;
  Matrix2d derivative;
};

Distorted distort(const Vector2d& p, const std::array<double, 5>& d) {
  const double x = p.x(), y = p.y(), r2 = x * x + y * y;
  const auto [k1, k2, p1, p2, k3] = d;
  const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
  const double slope = k1 + r2 * (2 * k2 + 3 * r2 * k3);  // d radial / d r2
  Distorted out;
  out.xy = {x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
            y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y};
  const double cross = 2 * x * y * slope + 2 * p1 * x + 2 * p2 * y;
  out.derivative << radial + 2 * x * x * slope + 2 * p1 * y + 6 * p2 * x, cross, cross,
      radial + 2 * y * y * slope + 6 * p1 * y + 2 * p2 * x;
  return out;
}

}  // namespace

Vector2d CameraModel::project(const Eigen::Vector3d& point) const {
  return pixel_from_normalised(point.head<2>() / point.z());
}

Vector2d CameraModel::pixel_from_normalised(const Vector2d& xy) const {
  const Vector2d q = distort(xy, distortion).xy;
  return {fx * q.x() + skew * q.y() + cx, fy * q.y() + cy};
}

Vector2d CameraModel::normalised_from_pixel(const Vector2d& uv) const {
  const double y = (uv.y() - cy) / fy;
  const Vector2d target{(uv.x() - cx - skew * y) / fx, y};
  Vector2d guess = target;
  for (int i = 0; i < 50; ++i) {
    const Distorted at = distort(guess, distortion);
    // Past the fold the picture is mirrored onto itself: no unique direction belongs to this pixel.
    if (!(at.derivative.determinant() > 1e-6)) break;
    const Vector2d step = at.derivative.inverse() * (target - at.xy);
    guess += step;
    if (step.squaredNorm() < 1e-24) return guess;
  }
  return Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
}

CameraModel CameraModel::scaled_to(int new_width, int new_height) const {
  CameraModel out = *this;
  const double sx = static_cast<double>(new_width) / width, sy = static_cast<double>(new_height) / height;
  out.width = new_width;
  out.height = new_height;
  out.fx *= sx;
  out.skew *= sx;
  out.fy *= sy;
  // Pixel centres are whole numbers: the picture's edge is at -0.5.
  out.cx = (cx + 0.5) * sx - 0.5;
  out.cy = (cy + 0.5) * sy - 0.5;
  return out;
}

Result<void> validate(const CameraModel& c) {
  if (c.width < 16 || c.height < 16) {
    return fail(ErrorCode::invalid,
                fmt::format("picture size {}x{} is too small: image_width and image_height are in pixels",
                            c.width, c.height));
  }
  const std::array values{c.fx,
                          c.fy,
                          c.skew,
                          c.cx,
                          c.cy,
                          c.distortion[0],
                          c.distortion[1],
                          c.distortion[2],
                          c.distortion[3],
                          c.distortion[4]};
  for (double v : values) {
    if (!std::isfinite(v))
      return fail(ErrorCode::invalid,
                  "camera_matrix or distortion_coefficients holds a number that is not finite");
  }
  if (c.fx == 0 || c.fy == 0) {
    return fail(ErrorCode::invalid, "camera_matrix is singular: a focal length is zero");
  }
  const double smallest = 0.1 * c.width;
  if (c.fx < smallest || c.fy < smallest || c.fx > 100.0 * c.width || c.fy > 100.0 * c.width) {
    return fail(
        ErrorCode::invalid,
        fmt::format(
            "focal length {:g} x {:g} cannot belong to a picture {} pixels wide: camera_matrix must be in "
            "pixels, not millimetres or picture widths",
            c.fx, c.fy, c.width));
  }
  if (c.cx < 0 || c.cy < 0 || c.cx > c.width || c.cy > c.height) {
    return fail(ErrorCode::invalid, fmt::format("principal point ({:g}, {:g}) lies outside the {}x{} picture",
                                                c.cx, c.cy, c.width, c.height));
  }
  return {};
}

}  // namespace linescope
