#include "viewer/navigate/normal_estimator.hpp"

#include <vector>

#include "viewer/navigate/angle_difference.hpp"
#include "viewer/navigate/left_right.hpp"

namespace linescope {
namespace {

struct Cloud {
  std::vector<Eigen::Vector3f> points;
  Eigen::Vector3d view_sum = Eigen::Vector3d::Zero();
  IndexCounts counts;
};

void take(Cloud& cloud, const SurfaceLine& line) {
  std::uint64_t taken = 0;
  for (const SurfacePoint& point : line.points) {
    if (!point.position.allFinite()) {
      ++cloud.counts.points_not_finite;
      continue;
    }
    cloud.points.push_back(point.position);
    ++taken;
  }
  cloud.counts.points += taken;
  ++(taken ? cloud.counts.lines : cloud.counts.lines_rejected);
  if (taken) cloud.view_sum += line.view.normalized();
}

}  // namespace

struct NormalEstimator::State {
  NormalEstimatorOptions options;
  LeftRight<Cloud> cloud;
};

Result<void> validate(const NormalEstimatorOptions& options) {
  return validate(options.algorithm_1);
}

NormalEstimator::NormalEstimator(const NormalEstimatorOptions& options) : state_(std::make_unique<State>()) {
  state_->options = options;
}
NormalEstimator::~NormalEstimator() = default;
NormalEstimator::NormalEstimator(NormalEstimator&&) noexcept = default;
NormalEstimator& NormalEstimator::operator=(NormalEstimator&&) noexcept = default;

void NormalEstimator::add_line(const SurfaceLine& line) {
  state_->cloud.write([&](Cloud& cloud) { take(cloud, line); });
}

void NormalEstimator::clear() {
  state_->cloud.write([](Cloud& cloud) { cloud = Cloud{}; });
}

NormalEstimate NormalEstimator::estimate(const NormalQuery& query) const {
  return estimate(query, state_->options.method);
}

NormalEstimate NormalEstimator::estimate(const NormalQuery& query, NormalMethod) const {
  return state_->cloud.read([&](const Cloud& cloud) {
    NormalEstimate result;
    result.method = NormalMethod::algorithm_1;
    if (cloud.points.empty()) return result;
    const InscribedTriangle triangle =
        inscribed_triangle(cloud.points, query.tip, cloud.view_sum.normalized(), state_->options.algorithm_1);
    result.reason = triangle.found ? NormalReason::none : NormalReason::no_triangle;
    result.fallback = !triangle.found;
    result.normal = triangle.normal;
    result.angle = angle_difference(triangle.normal, query.axis);
    return result;
  });
}

IndexCounts NormalEstimator::counts() const {
  return state_->cloud.read([](const Cloud& cloud) { return cloud.counts; });
}

}  // namespace linescope
