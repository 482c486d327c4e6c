#include "viewer/navigate/line_segments.hpp"

#include <algorithm>
#include <cmath>

namespace linescope {
namespace {

/// Main direction of a piece across the view.
Eigen::Vector3d main_direction(const Moments& m, const Eigen::Vector3d& view) {
  const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - view * view.transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(across * m.covariance() * across);
  return solver.eigenvectors().col(2);
}

struct StraightLine {
  double level = 0;
  double slope = 0;
  double at(double along) const { return level + slope * along; }
};

}  // namespace

const std::vector<CutSegment>& LineCutter::cut(const SurfaceLine& line, const Eigen::Vector3d& view,
                                               const CellGrid& grid) {
  used_pieces_ = last_piece_ = 0;
  unusable_ = 0;
  segments_.clear();
  for (std::uint32_t i = 0; i < line.points.size(); ++i) {
    const Eigen::Vector3d p = line.points[i].position.cast<double>();
    if (!p.allFinite() || !grid.holds(p)) {
      ++unusable_;
      continue;
    }
    piece_of(grid.cell_of(p)).members.push_back(i);
  }
  for (std::size_t i = 0; i < used_pieces_; ++i) summarise(line, pieces_[i], view, grid);
  return segments_;
}

LineCutter::Piece& LineCutter::piece_of(const CellIndex& cell) {
  if (last_piece_ < used_pieces_ && pieces_[last_piece_].cell == cell) return pieces_[last_piece_];
  for (last_piece_ = 0; last_piece_ < used_pieces_; ++last_piece_)
    if (pieces_[last_piece_].cell == cell) return pieces_[last_piece_];
  if (used_pieces_ == pieces_.size()) pieces_.emplace_back();
  ++used_pieces_;
  pieces_[last_piece_].cell = cell;
  pieces_[last_piece_].members.clear();
  return pieces_[last_piece_];
}

void LineCutter::summarise(const SurfaceLine& line, const Piece& piece, const Eigen::Vector3d& view,
                           const CellGrid& grid) {
  const std::vector<std::uint32_t> left_out = emit(line, piece, piece.members, view, grid);
  const auto many =
      static_cast<std::size_t>(options_.second_share * static_cast<double>(piece.members.size()));
  if (left_out.size() < static_cast<std::size_t>(options_.second_points) || left_out.size() < many) return;
  segments_.back().segment.rejected = 0;
  emit(line, piece, left_out, view, grid);
}

double LineCutter::deviation_of(const SurfacePoint& point) const {
  return point.standard_deviation > 0 ? point.standard_deviation : options_.unknown_deviation;
}

std::vector<std::uint32_t> LineCutter::emit(const SurfaceLine& line, const Piece& piece,
                                            const std::vector<std::uint32_t>& members,
                                            const Eigen::Vector3d& view, const CellGrid& grid) {
  const Eigen::Vector3d centre = grid.centre_of(piece.cell);
  Moments all;
  for (const std::uint32_t i : members) all.add(line.points[i].position.cast<double>() - centre);
  const Eigen::Vector3d direction = main_direction(all, view);
  samples_.clear();
  for (const std::uint32_t i : members) {
    const Eigen::Vector3d p = line.points[i].position.cast<double>() - centre;
    samples_.push_back({p.dot(direction), -p.dot(view), 1.0, i});
  }

  // Least sum of absolute residuals by re-weighting: not bent by a minority of wild points.
  StraightLine fit;
  residuals_.resize(samples_.size());
  for (int round = 0; round < 6; ++round) {
    double w = 0, s = 0, h = 0, ss = 0, sh = 0;
    for (const Sample& q : samples_) {
      w += q.weight;
      s += q.weight * q.along;
      h += q.weight * q.height;
      ss += q.weight * q.along * q.along;
      sh += q.weight * q.along * q.height;
    }
    const double spread = ss - s * s / w;
    fit.slope = spread > 1e-9 * w ? (sh - s * h / w) / spread : 0;
    fit.level = (h - fit.slope * s) / w;
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      residuals_[i] = std::abs(samples_[i].height - fit.at(samples_[i].along));
      samples_[i].weight = 1 / std::max(residuals_[i], 0.01);
    }
  }
  const auto middle = residuals_.begin() + static_cast<std::ptrdiff_t>(residuals_.size() / 2);
  std::nth_element(residuals_.begin(), middle, residuals_.end());
  const double limit = std::max(options_.smallest_cut, options_.cut * 1.4826 * *middle);

  CutSegment out{piece.cell, {}, {}, {}};
  std::vector<std::uint32_t> left_out;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double weights = 0, along = 0, along_squared = 0;
  for (const Sample& q : samples_) {
    if (std::abs(q.height - fit.at(q.along)) > limit) {
      left_out.push_back(q.member);
      continue;
    }
    const SurfacePoint& point = line.points[q.member];
    const Eigen::Vector3d p = point.position.cast<double>() - centre;
    const double weight = 1 / (deviation_of(point) * deviation_of(point));
    weights += weight;
    sum += weight * p;
    along += weight * q.along;
    along_squared += weight * q.along * q.along;
    out.moments.add(p);
    out.points.push_back(point.position);
  }
  const double mean_along = along / weights;
  const double deviation = std::sqrt(std::max(0.0, along_squared / weights - mean_along * mean_along));
  out.segment.mean = (centre + sum / weights).cast<float>();
  out.segment.spread = (deviation * (direction - fit.slope * view)).cast<float>();
  out.segment.variance = static_cast<float>(1 / weights);
  out.segment.count = static_cast<std::uint16_t>(std::min<std::size_t>(out.points.size(), 65535));
  out.segment.rejected = static_cast<std::uint16_t>(std::min<std::size_t>(left_out.size(), 65535));
  segments_.push_back(std::move(out));
  return left_out;
}

}  // namespace linescope
