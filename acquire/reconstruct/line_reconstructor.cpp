#include "acquire/reconstruct/line_reconstructor.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "acquire/reconstruct/laser_surface.hpp"
#include "acquire/reconstruct/ray_table.hpp"

namespace linescope {
namespace {

/// Camera to world in single precision: 0.1 micrometre at 1 m.
struct Placement {
  Eigen::Matrix3f rotation;
  Eigen::Vector3f translation;
};

struct Judge {
  float least_depth, most_depth, line_noise_px;
};

void refuse(ReconstructedLine& out, NoSurface reason) {
  ++out.no_surface[static_cast<std::size_t>(reason)];
}

/// Squared noise of the line's middle, px^2. A Gaussian line of width s, peak A in noise n cannot be placed
/// better than (n / A) sqrt(2 s / sqrt(pi)).
float centre_variance(const LineSample& s, float line_noise_px) {
  const float camera = 1.12838F * s.width / (s.snr * s.snr);
  return camera + line_noise_px * line_noise_px;
}

template <LaserSurface Surface>
void place(const ExtractedLine& line, const RayTable& rays, const Surface& surface, const Judge& judge,
           const Placement& world_from_camera, ReconstructedLine& out) {
  for (const LineSample& s : line.samples) {
    if (!std::isfinite(s.u + s.v)) {
      refuse(out, NoSurface::not_finite);
      continue;
    }
    const Ray ray = rays.at(s.u, s.v, line.axis);
    if (!std::isfinite(ray.x + ray.x_step)) {
      refuse(out, NoSurface::outside_lens);
      continue;
    }
    const SurfaceHit hit = surface.meet(ray.x, ray.y);
    if (!(hit.depth > 0) || !std::isfinite(hit.depth)) {
      refuse(out, NoSurface::behind);
      continue;
    }
    if (hit.depth < judge.least_depth || hit.depth > judge.most_depth) {
      refuse(out, NoSurface::out_of_range);
      continue;
    }
    const Eigen::Vector3f direction(ray.x, ray.y, 1);
    const float depth_per_px = hit.by_x * ray.x_step + hit.by_y * ray.y_step;
    SurfacePoint p;
    p.position = world_from_camera.rotation * (hit.depth * direction) + world_from_camera.translation;
    p.intensity = s.peak;
    p.standard_deviation =
        std::abs(depth_per_px) * std::sqrt(centre_variance(s, judge.line_noise_px) * direction.squaredNorm());
    out.points.push_back(p);
    out.pixels.emplace_back(s.u, s.v);
  }
}

void clear(ReconstructedLine& out) {
  out.points.clear();
  out.pixels.clear();
  out.no_surface = {};
}

Eigen::Vector3f mean_direction(const ReconstructedLine& out, const Eigen::Vector3f& axis) {
  if (out.points.empty()) return axis;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const SurfacePoint& p : out.points) sum += (p.position - out.camera_in_world).cast<double>();
  return sum.normalized().cast<float>();
}

}  // namespace

struct LineReconstructor::Tables {
  Tables(const Calibration& c, const LineReconstructorOptions& o)
      : calibration(c), options(o), rays(c.camera), surface(c.laser) {}
  Calibration calibration;
  LineReconstructorOptions options;
  RayTable rays;
  PlaneSurface surface;
};

Result<void> validate(const LineReconstructorOptions& o) {
  if (!(o.min_depth_mm >= 0 && o.max_depth_mm > o.min_depth_mm && o.max_depth_mm <= 100000)) {
    return fail(ErrorCode::invalid,
                fmt::format("reconstruction: depths from {:g} to {:g} mm are no range within 0 .. 100000 mm",
                            o.min_depth_mm, o.max_depth_mm));
  }
  if (!(o.line_noise_px >= 0 && o.line_noise_px <= 100)) {
    return fail(
        ErrorCode::invalid,
        fmt::format("reconstruction: line_noise_px is {:g}, but must lie in 0 .. 100", o.line_noise_px));
  }
  return {};
}

std::string_view name(NoSurface reason) {
  switch (reason) {
    case NoSurface::not_finite:
      return "not finite";
    case NoSurface::outside_lens:
      return "outside the lens model";
    case NoSurface::behind:
      return "behind the camera";
    case NoSurface::out_of_range:
      return "out of the depth range";
  }
  return "unknown";
}

Result<LineReconstructor> LineReconstructor::create(const Calibration& calibration,
                                                    const LineReconstructorOptions& options) {
  if (auto ok = validate(calibration); !ok) return tl::unexpected(ok.error());
  if (auto ok = validate(options); !ok) return tl::unexpected(ok.error());
  return LineReconstructor(std::make_shared<const Tables>(calibration, options));
}

Result<void> LineReconstructor::reconstruct(const ExtractedLine& line,
                                            const Rigid<World, Endoscope>& world_from_endoscope,
                                            ReconstructedLine& out) const {
  clear(out);
  const CameraModel& camera = tables_->calibration.camera;
  if (line.width != camera.width || line.height != camera.height) {
    return fail(ErrorCode::mismatch, fmt::format("the picture is {}x{}, but the calibration is for {}x{}: "
                                                 "use the calibration of this camera and size",
                                                 line.width, line.height, camera.width, camera.height));
  }
  if (!world_from_endoscope.finite()) return fail(ErrorCode::invalid, "the endoscope's pose is not finite");
  const Rigid<World, CameraCv> world_from_camera =
      world_from_endoscope * tables_->calibration.endoscope_from_camera;
  const Placement placement{world_from_camera.rotation().toRotationMatrix().cast<float>(),
                            world_from_camera.translation().cast<float>()};
  const LineReconstructorOptions& o = tables_->options;
  const Judge judge{static_cast<float>(o.min_depth_mm), static_cast<float>(o.max_depth_mm),
                    static_cast<float>(o.line_noise_px)};
  place(line, tables_->rays, tables_->surface, judge, placement, out);
  out.camera_in_world = placement.translation;
  out.viewing_direction = mean_direction(out, placement.rotation.col(2));
  return {};
}

const Calibration& LineReconstructor::calibration() const {
  return tables_->calibration;
}
const LineReconstructorOptions& LineReconstructor::options() const {
  return tables_->options;
}

}  // namespace linescope
