// The normal under the harvester: lines of points go in as they are scanned, a tip and an axis ask for the
// normal.
//
// Frame: the object's (sensor 2) throughout, so that a moving knee moves nothing here. Millimetres, radians.
// Threads: one writer (add_line, clear) and any number of readers (estimate, counts) at the same time. A
// reader never waits for the writer; it sees each line whole or not at all. The writer may wait for readers
// that are under way. Methods: Algorithm 1 of the thesis (algorithm_1.hpp) and the robust estimate
// (docs/navigation.md says how and why).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "common/result.hpp"
#include "viewer/navigate/algorithm_1.hpp"
#include "viewer/navigate/live_index.hpp"
#include "viewer/navigate/normal_estimate.hpp"
#include "viewer/navigate/robust_normal.hpp"

namespace linescope {

struct NormalEstimatorOptions {
  NormalMethod method = NormalMethod::robust;  ///< what `estimate` without a method uses
  Algorithm1Options algorithm_1;
  RobustNormalOptions robust;
  LiveIndexOptions index;
};

/// The first fault of the options, in one sentence.
Result<void> validate(const NormalEstimatorOptions& options);

class NormalEstimator {
 public:
  /// Precondition: validate(options) is good.
  explicit NormalEstimator(const NormalEstimatorOptions& options = {});
  ~NormalEstimator();
  NormalEstimator(NormalEstimator&&) noexcept;
  NormalEstimator& operator=(NormalEstimator&&) noexcept;

  /// Writer only. Bad points are left out and counted.
  void add_line(const NavigationLine& line);
  /// Writer only. Forgets the surface and the counts.
  void clear();

  NormalEstimate estimate(const NormalQuery& query) const;
  NormalEstimate estimate(const NormalQuery& query, NormalMethod method) const;

  /// The plain normal at a place: plane through the points near by, no uncertainty and no judgement (target
  /// T13).
  std::optional<FittedPlane> plane_near(const Eigen::Vector3d& place) const;

  IndexCounts counts() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace linescope
