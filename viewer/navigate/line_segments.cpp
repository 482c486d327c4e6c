#include "viewer/navigate/line_segments.hpp"

#include <algorithm>
#include <cmath>

namespace linescope {
namespace {

/// Main direction of points across the view.
Eigen::Vector3d main_direction(const Moments& m, const Eigen::Vector3d& view) {
  const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - view * view.transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(across * m.covariance() * across);
  return solver.eigenvectors().col(2);
}

struct StraightLine {
  double level = 0;
  double slope = 0;
  double residual(double along, double height) const { return std::abs(height - level - slope * along); }
};

/// Weighted least squares; level only where the samples have no length.
template <class Iterator>
StraightLine weighted_line(Iterator begin, Iterator end) {
  double w = 0, s = 0, h = 0, ss = 0, sh = 0;
  for (auto q = begin; q != end; ++q) {
    w += q->weight;
    s += q->weight * q->along;
    h += q->weight * q->height;
    ss += q->weight * q->along * q->along;
    sh += q->weight * q->along * q->height;
  }
  StraightLine fit;
  const double spread = ss - s * s / w;
  fit.slope = spread > 1e-9 * w ? (sh - s * h / w) / spread : 0;
  fit.level = (h - fit.slope * s) / w;
  return fit;
}

/// Least sum of absolute residuals by re-weighting: not bent by a minority of wild points.
template <class Iterator>
StraightLine robust_line(Iterator begin, Iterator end) {
  constexpr double kNearlyNothing = 0.005;
  for (auto q = begin; q != end; ++q) q->weight = 1;
  StraightLine fit = weighted_line(begin, end);
  for (int round = 0; round < 6; ++round) {
    for (auto q = begin; q != end; ++q)
      q->weight = 1 / std::max(fit.residual(q->along, q->height), kNearlyNothing);
    fit = weighted_line(begin, end);
  }
  return fit;
}

std::uint16_t clipped(std::ptrdiff_t n) {
  return static_cast<std::uint16_t>(std::min<std::ptrdiff_t>(n, 65535));
}

}  // namespace

const std::vector<CutSegment>& LineCutter::cut(const NavigationLine& line, const Eigen::Vector3d& view,
                                               const CellGrid& grid) {
  segments_.clear();
  collect(line, view, grid);
  std::stable_sort(samples_.begin(), samples_.end(),
                   [](const Sample& a, const Sample& b) { return a.piece < b.piece; });
  for (auto begin = samples_.begin(); begin != samples_.end();) {
    const auto end =
        std::find_if(begin, samples_.end(), [&](const Sample& q) { return q.piece != begin->piece; });
    summarise(begin, end, view, grid);
    begin = end;
  }
  return segments_;
}

void LineCutter::collect(const NavigationLine& line, const Eigen::Vector3d& view, const CellGrid& grid) {
  samples_.clear();
  unusable_ = 0;
  Moments all;
  for (const SurfacePoint& point : line.points) {
    const Eigen::Vector3d p = point.position.cast<double>();
    if (!p.allFinite() || !grid.holds(p)) {
      ++unusable_;
      continue;
    }
    if (samples_.empty()) origin_ = p;
    Sample sample;
    sample.position = p - origin_;
    sample.height = -sample.position.dot(view);
    sample.deviation = point.standard_deviation > 0 ? static_cast<double>(point.standard_deviation)
                                                    : options_.unknown_deviation;
    all.add(sample.position);
    samples_.push_back(sample);
  }
  if (samples_.empty()) return;
  direction_ = main_direction(all, view);
  for (Sample& sample : samples_) {
    sample.along = sample.position.dot(direction_);
    sample.piece = static_cast<int>(std::floor(std::clamp(sample.along / options_.length, -1e9, 1e9)));
  }
}

void LineCutter::summarise(Samples begin, Samples end, const Eigen::Vector3d& view, const CellGrid& grid) {
  const Samples left_out = emit(begin, end, view, grid);
  const auto number = end - left_out;
  const double many = options_.second_share * static_cast<double>(end - begin);
  if (number < options_.second_points || static_cast<double>(number) < many) return;
  segments_.back().segment.rejected = 0;
  emit(left_out, end, view, grid);
}

LineCutter::Samples LineCutter::emit(Samples begin, Samples end, const Eigen::Vector3d& view,
                                     const CellGrid& grid) {
  const StraightLine fit = robust_line(begin, end);
  residuals_.clear();
  for (auto q = begin; q != end; ++q) residuals_.push_back(fit.residual(q->along, q->height));
  const auto middle = residuals_.begin() + static_cast<std::ptrdiff_t>(residuals_.size() / 2);
  std::nth_element(residuals_.begin(), middle, residuals_.end());
  const double limit = std::max(options_.smallest_cut, options_.cut * 1.4826 * *middle);
  const Samples kept = std::stable_partition(
      begin, end, [&](const Sample& q) { return fit.residual(q.along, q.height) <= limit; });

  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double weights = 0, along = 0, along_squared = 0;
  for (auto q = begin; q != kept; ++q) {
    const double weight = 1 / (q->deviation * q->deviation);
    weights += weight;
    sum += weight * q->position;
    along += weight * q->along;
    along_squared += weight * q->along * q->along;
  }
  along /= weights;
  const double spread = std::sqrt(std::max(0.0, along_squared / weights - along * along));
  const Eigen::Vector3d mean = origin_ + sum / weights;

  CutSegment& out = segments_.emplace_back();
  out.cell = grid.cell_of(mean);
  out.segment.mean = mean.cast<float>();
  out.segment.spread = (spread * (direction_ - fit.slope * view)).cast<float>();
  out.segment.variance = static_cast<float>(1 / weights);
  out.segment.count = clipped(kept - begin);
  out.segment.rejected = clipped(end - kept);
  const Eigen::Vector3d from_centre = origin_ - grid.centre_of(out.cell);
  for (auto q = begin; q != kept; ++q) {
    out.moments.add(q->position + from_centre);
    out.points.push_back((q->position + origin_).cast<float>());
  }
  return kept;
}

}  // namespace linescope
