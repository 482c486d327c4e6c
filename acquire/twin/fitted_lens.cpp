#include "acquire/twin/fitted_lens.hpp"

#include <Eigen/QR>
#include <vector>

#include "acquire/twin/lens.hpp"
#include "acquire/twin/view_rays.hpp"

namespace linescope::twin {
namespace {

using Eigen::Vector2d;
using Parameters = Eigen::Matrix<double, 8, 1>;  // fx fy cx cy k1 k2 p1 p2

struct Sighting {
  Vector2d pixel;
  Vector2d slope;  ///< x/z, y/z of a point on the pixel's ray
};

LensNumbers lens_of(const Parameters& p, const LensNumbers& like) {
  return {like.width, like.height, p[0], p[1], p[2], p[3], {p[4], p[5], p[6], p[7], 0}};
}

Parameters parameters_of(const LensNumbers& l) {
  Parameters p;
  p << l.fx, l.fy, l.cx, l.cy, l.distortion[0], l.distortion[1], l.distortion[2], l.distortion[3];
  return p;
}

std::vector<Sighting> sightings(const TwinOptions& options) {
  const LensNumbers& lens = options.instrument.lens;
  const ViewRays rays(lens, options.optics.port, options.optics.prism.medium_index);
  std::vector<Sighting> seen;
  for (int j = 0; j <= 12; ++j) {
    for (int i = 0; i <= 16; ++i) {
      const Vector2d pixel((lens.width - 1) * i / 16.0, (lens.height - 1) * j / 12.0);
      const ViewRay ray = rays.at(pixel.x(), pixel.y());
      if (!ray.lit()) continue;
      for (const double depth : {8.0, 12.0, 16.0, 22.0}) {
        const Eigen::Vector3d point =
            ray.origin + ray.direction * ((depth - ray.origin.z()) / ray.direction.z());
        seen.push_back({pixel, point.head<2>() / point.z()});
      }
    }
  }
  return seen;
}

Eigen::VectorXd misses(const Parameters& p, const std::vector<Sighting>& seen, const LensNumbers& like) {
  const Lens lens(lens_of(p, like));
  Eigen::VectorXd all(2 * static_cast<Eigen::Index>(seen.size()));
  for (std::size_t i = 0; i < seen.size(); ++i) {
    all.segment<2>(2 * static_cast<Eigen::Index>(i)) = lens.pixel(seen[i].slope) - seen[i].pixel;
  }
  return all;
}

}  // namespace

LensNumbers fitted_lens(const TwinOptions& options) {
  const LensNumbers& like = options.instrument.lens;
  const std::vector<Sighting> seen = sightings(options);
  Parameters p = parameters_of(like);
  for (int round = 0; round < 15; ++round) {
    const Eigen::VectorXd now = misses(p, seen, like);
    Eigen::MatrixXd slopes(now.size(), p.size());
    for (Eigen::Index k = 0; k < p.size(); ++k) {
      Parameters moved = p;
      const double step = k < 4 ? 1e-3 : 1e-6;
      moved[k] += step;
      slopes.col(k) = (misses(moved, seen, like) - now) / step;
    }
    p -= slopes.colPivHouseholderQr().solve(now);
  }
  return lens_of(p, like);
}

}  // namespace linescope::twin
