// A session on the digital twin: rendered once, acquired as often as there are algorithms to compare.
#pragma once

#include <memory>
#include <vector>

#include "acquire/camera/camera_source.hpp"
#include "acquire/twin/virtual_experiment.hpp"
#include "tools/evaluate/session_run.hpp"

namespace linescope::evaluate {

class VirtualSession {
 public:
  /// Renders all pictures of an experiment, whose duration must not be endless.
  static Result<VirtualSession> render(const twin::TwinOptions& options);

  /// No pictures but a black one at the end: for what only poses are needed of.
  static Result<VirtualSession> without_pictures(const twin::TwinOptions& options);

  /// The daemon on it. The same options give the same lines.
  Result<Session> acquire(const SessionOptions& options) const;

  const twin::TwinTruth& truth() const { return experiment_->truth(); }
  Calibration calibration() const { return experiment_->calibration(); }
  std::size_t pictures() const { return pictures_->size(); }

  /// The phantom's own frame, in which the surface is known.
  Rigid<twin::PhantomFrame, Object> phantom_from_object() const;

 private:
  VirtualSession(std::shared_ptr<const twin::VirtualExperiment> experiment,
                 std::shared_ptr<const std::vector<Frame>> pictures)
      : experiment_(std::move(experiment)), pictures_(std::move(pictures)) {}

  std::shared_ptr<const twin::VirtualExperiment> experiment_;
  std::shared_ptr<const std::vector<Frame>> pictures_;
};

/// The two columns of the report: the line's plain weighted mean placed at the pose of its instant, and what
/// the daemon does by itself (Gauss-weighted middle, pose averaged over some samples).
SessionOptions thesis_session();
SessionOptions better_session();

}  // namespace linescope::evaluate
