#include "acquire/reconstruct/line_reconstructor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "acquire/reconstruct/laser_surface.hpp"
#include "acquire/reconstruct/ray_table.hpp"
#include "common/processor.hpp"

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

/// Samples that are worked on together, number by number instead of point by point: the loops over them
/// become vector code.
struct Batch {
  static constexpr std::size_t kSize = 64;
  using Row = std::array<float, kSize>;
  Row x, y, x_step, y_step;  ///< rays
  Row width, snr;            ///< samples
  Row depth, deviation;      ///< mm
  Row px, py, pz;            ///< camera's centre to the point, world, mm
};

void load(std::span<const LineSample> samples, RayProfiles rays, Batch& b) {
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const LineSample& s = samples[i];
    const Ray ray = rays.at(s.u, s.v);
    b.x[i] = ray.x, b.y[i] = ray.y;
    b.x_step[i] = ray.x_step, b.y_step[i] = ray.y_step;
    b.width[i] = s.width, b.snr[i] = s.snr;
  }
}

/// Along its viewing ray a point is known as well as the line's middle (px) times how far a pixel moves it
/// there: on the laser surface both the depth and the ray change. A Gaussian line of width s, peak A in noise
/// n cannot be placed better than (n / A) sqrt(2 s / sqrt(pi)).
template <LaserSurface Surface>
__attribute__((always_inline)) inline void intersect_by(const Surface& surface,
                                                        const Eigen::Matrix3f& rotation, float line_noise_px,
                                                        std::size_t n, Batch& b) {
  const std::array<float, 9> r{rotation(0, 0), rotation(0, 1), rotation(0, 2), rotation(1, 0), rotation(1, 1),
                               rotation(1, 2), rotation(2, 0), rotation(2, 1), rotation(2, 2)};
  const float other = line_noise_px * line_noise_px;
  for (std::size_t i = 0; i < n; ++i) {
    const float x = b.x[i], y = b.y[i];
    const SurfaceHit hit = surface.meet(x, y);
    b.depth[i] = hit.depth;
    b.px[i] = hit.depth * (r[0] * x + r[1] * y + r[2]);
    b.py[i] = hit.depth * (r[3] * x + r[4] * y + r[5]);
    b.pz[i] = hit.depth * (r[6] * x + r[7] * y + r[8]);
    const float squared = x * x + y * y + 1, snr2 = b.snr[i] * b.snr[i];
    const float per_px = (hit.by_x * b.x_step[i] + hit.by_y * b.y_step[i]) * squared +
                         hit.depth * (x * b.x_step[i] + y * b.y_step[i]);
    b.deviation[i] = std::abs(per_px) * std::sqrt((1.12838F * b.width[i] + other * snr2) / (snr2 * squared));
  }
}

#if defined(__x86_64__)
template <LaserSurface Surface>
__attribute__((target("avx2"))) void intersect_avx2(const Surface& surface, const Eigen::Matrix3f& rotation,
                                                    float line_noise_px, std::size_t n, Batch& b) {
  intersect_by(surface, rotation, line_noise_px, n, b);
}
#endif

/// The same arithmetic by the longest vectors the processor has, rounded alike: no fused multiplications.
template <LaserSurface Surface>
void intersect(const Surface& surface, const Eigen::Matrix3f& rotation, float line_noise_px, std::size_t n,
               Batch& b) {
#if defined(__x86_64__)
  if (has_avx2()) return intersect_avx2(surface, rotation, line_noise_px, n, b);
#endif
  intersect_by(surface, rotation, line_noise_px, n, b);
}

/// Of a sample whose depth lies not within the limits.
NoSurface reason_for(const LineSample& s, float ray_x, float depth, const Judge& judge) {
  if (!std::isfinite(s.u + s.v)) return NoSurface::not_finite;
  if (!std::isfinite(ray_x)) return NoSurface::outside_lens;
  if (!(depth > 0) || !std::isfinite(depth)) return NoSurface::behind;
  return depth < judge.least_depth ? NoSurface::too_near : NoSurface::too_far;
}

/// Appends the good ones at `at`; returns where the next one goes.
std::size_t store(std::span<const LineSample> samples, const Batch& b, const Judge& judge,
                  const Eigen::Vector3f& camera, std::size_t at, ReconstructedLine& out) {
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const LineSample& s = samples[i];
    if (!(b.depth[i] > 0 && b.depth[i] >= judge.least_depth && b.depth[i] <= judge.most_depth)) {
      ++out.no_surface[static_cast<std::size_t>(reason_for(s, b.x[i], b.depth[i], judge))];
      continue;
    }
    SurfacePoint& p = out.points[at];
    p.position = {camera.x() + b.px[i], camera.y() + b.py[i], camera.z() + b.pz[i]};
    p.intensity = s.peak;
    p.standard_deviation = b.deviation[i];
    out.pixels[at++] = {s.u, s.v};
  }
  return at;
}

template <LaserSurface Surface>
void place(const ExtractedLine& line, RayProfiles rays, const Surface& surface, const Judge& judge,
           const Placement& world_from_camera, ReconstructedLine& out) {
  const std::size_t count = line.samples.size();
  out.points.resize(count);
  out.pixels.resize(count);
  Batch batch;
  std::size_t at = 0;
  for (std::size_t begin = 0; begin < count; begin += Batch::kSize) {
    const std::span samples = std::span(line.samples).subspan(begin, std::min(Batch::kSize, count - begin));
    load(samples, rays, batch);
    intersect(surface, world_from_camera.rotation, judge.line_noise_px, samples.size(), batch);
    at = store(samples, batch, judge, world_from_camera.translation, at, out);
  }
  out.points.resize(at);
  out.pixels.resize(at);
}

void clear(ReconstructedLine& out) {
  out.points.clear();
  out.pixels.clear();
  out.no_surface = {};
}

/// Four at a time, so that one addition need not wait for the one before.
Eigen::Vector3f mean_direction(const ReconstructedLine& out, const Eigen::Vector3f& axis) {
  const std::vector<SurfacePoint>& p = out.points;
  if (p.empty()) return axis;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  std::size_t i = 0;
  for (; i + 4 <= p.size(); i += 4) {
    const Eigen::Vector3f first = p[i].position + p[i + 1].position;
    const Eigen::Vector3f last = p[i + 2].position + p[i + 3].position;
    sum += (first + last).cast<double>();
  }
  for (; i < p.size(); ++i) sum += p[i].position.cast<double>();
  const Eigen::Vector3d middle = sum / static_cast<double>(p.size());
  return (middle - out.camera_in_world.cast<double>()).normalized().cast<float>();
}

}  // namespace

struct LineReconstructor::Tables {
  Tables(const Calibration& c, const LineReconstructorOptions& o)
      : calibration(c), options(o), rays(c.camera), plane(c.laser), bent(c.laser, c.laser_bend) {}
  Calibration calibration;
  LineReconstructorOptions options;
  RayTable rays;
  PlaneSurface plane;
  BentSurface bent;
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
    case NoSurface::too_near:
      return "too near";
    case NoSurface::too_far:
      return "too far";
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
  out.no_surface = {};
  const CameraModel& camera = tables_->calibration.camera;
  if (line.width != camera.width || line.height != camera.height) {
    clear(out);
    return fail(ErrorCode::mismatch, fmt::format("the picture is {}x{}, but the calibration is for {}x{}: "
                                                 "use the calibration of this camera and size",
                                                 line.width, line.height, camera.width, camera.height));
  }
  if (!world_from_endoscope.finite()) {
    clear(out);
    return fail(ErrorCode::invalid, "the endoscope's pose is not finite");
  }
  const Rigid<World, CameraCv> world_from_camera =
      world_from_endoscope * tables_->calibration.endoscope_from_camera;
  const Placement placement{world_from_camera.rotation().toRotationMatrix().cast<float>(),
                            world_from_camera.translation().cast<float>()};
  const LineReconstructorOptions& o = tables_->options;
  const Judge judge{static_cast<float>(o.min_depth_mm), static_cast<float>(o.max_depth_mm),
                    static_cast<float>(o.line_noise_px)};
  const RayProfiles rays = tables_->rays.along(line.axis);
  if (tables_->calibration.laser_bend.flat())
    place(line, rays, tables_->plane, judge, placement, out);
  else
    place(line, rays, tables_->bent, judge, placement, out);
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
