#include "viewer/navigate/normal_estimator.hpp"

#include <cmath>
#include <vector>

#include "viewer/navigate/angle_difference.hpp"
#include "viewer/navigate/left_right.hpp"

namespace linescope {
namespace {

/// Algorithm 1 on the index: first among points near the circle; what lies farther from it than the found
/// triangle's worst cost cannot have been chosen, so the answer is the one over all points.
InscribedTriangle triangle_at(const LiveIndex& index, const NormalQuery& query, const Eigen::Vector3d& view,
                              const Algorithm1Options& options) {
  constexpr double kFirstShell = 0.2;
  thread_local std::vector<Eigen::Vector3f> points;
  points.clear();
  index.collect_shell(query.tip, options.radius - kFirstShell, options.radius + kFirstShell, points);
  const InscribedTriangle first = inscribed_triangle(points, query.tip, view, options);
  if (first.found && first.worst_cost < kFirstShell) return first;
  points.clear();
  index.collect_shell(query.tip, 1.0, options.line_width / 2, points);
  return inscribed_triangle(points, query.tip, view, options);
}

NormalEstimate algorithm_1(const LiveIndex& index, const NormalQuery& query,
                           const Algorithm1Options& options) {
  NormalEstimate result;
  result.method = NormalMethod::algorithm_1;
  const Eigen::Vector3d axis = query.axis.normalized();
  if (!query.tip.allFinite() || !axis.allFinite() || !(axis.norm() > 0.5) || !index.grid().holds(query.tip)) {
    result.reason = NormalReason::bad_query;
    return result;
  }
  if (index.empty()) return result;
  const Eigen::Vector3d view = index.view_near(query.tip, options.line_width / 2).value_or(-axis);
  const InscribedTriangle triangle = triangle_at(index, query, view, options);
  result.normal = triangle.normal;
  result.fallback = !triangle.found;
  result.reason = triangle.found ? NormalReason::none : NormalReason::no_triangle;
  result.angle = angle_difference(result.normal, axis);
  if (!triangle.found) return result;
  result.counts.points = 3;
  const Eigen::Vector3d centre = (triangle.vertices[0] + triangle.vertices[1] + triangle.vertices[2]) / 3;
  result.distance = (query.tip - centre).dot(result.normal);
  result.nearest = query.tip - result.distance * result.normal;
  result.nearest_normal = result.normal;
  result.depth = result.distance / result.normal.dot(axis);
  result.foot = query.tip - result.depth * axis;
  return result;
}

}  // namespace

struct NormalEstimator::State {
  explicit State(const NormalEstimatorOptions& o)
      : options(o), index(o.index), cutter(o.index.segments), grid(o.index.cell_size) {}

  NormalEstimatorOptions options;
  LeftRight<LiveIndex> index;
  LineCutter cutter;  ///< writer only
  CellGrid grid;      ///< writer only; measures, holds no cells
};

Result<void> validate(const NormalEstimatorOptions& options) {
  if (auto result = validate(options.algorithm_1); !result) return result;
  if (auto result = validate(options.index); !result) return result;
  return validate(options.robust);
}

NormalEstimator::NormalEstimator(const NormalEstimatorOptions& options)
    : state_(std::make_unique<State>(options)) {}
NormalEstimator::~NormalEstimator() = default;
NormalEstimator::NormalEstimator(NormalEstimator&&) noexcept = default;
NormalEstimator& NormalEstimator::operator=(NormalEstimator&&) noexcept = default;

void NormalEstimator::add_line(const NavigationLine& line) {
  const Eigen::Vector3d view = line.view.normalized();
  if (!view.allFinite() || !(view.norm() > 0.5)) {
    state_->index.write([&](LiveIndex& index) { index.reject_line(line.points.size()); });
    return;
  }
  const auto& segments = state_->cutter.cut(line, view, state_->grid);
  const std::uint64_t unusable = state_->cutter.unusable_points();
  const LineInfo info{line.id, line.time, view.cast<float>()};
  state_->index.write([&](LiveIndex& index) { index.add(info, segments, unusable); });
}

void NormalEstimator::clear() {
  state_->index.write([](LiveIndex& index) { index.clear(); });
}

NormalEstimate NormalEstimator::estimate(const NormalQuery& query) const {
  return estimate(query, state_->options.method);
}

NormalEstimate NormalEstimator::estimate(const NormalQuery& query, NormalMethod method) const {
  return state_->index.read([&](const LiveIndex& index) {
    return method == NormalMethod::robust ? robust_normal(index, query, state_->options.robust)
                                          : algorithm_1(index, query, state_->options.algorithm_1);
  });
}

std::optional<FittedPlane> NormalEstimator::plane_near(const Eigen::Vector3d& place) const {
  return state_->index.read([&](const LiveIndex& index) { return index.plane_near(place); });
}

IndexCounts NormalEstimator::counts() const {
  return state_->index.read([](const LiveIndex& index) { return index.counts(); });
}

}  // namespace linescope
