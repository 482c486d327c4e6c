// A session on the digital twin: rendered once, acquired as often as there are algorithms to compare.
#pragma once

#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

#include "acquire/camera/camera_source.hpp"
#include "acquire/twin/virtual_experiment.hpp"
#include "tools/evaluate/session_run.hpp"
#include "tools/evaluate/surfaces.hpp"

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

/// The two columns of the report: the line's plain weighted mean, and what the daemon does by itself
/// (Gauss-weighted middle).
SessionOptions thesis_session();
SessionOptions better_session();

/// One value per column.
template <class T>
struct Columns {
  T plain, better;
};

/// Renders once and asks measure(session, algorithms, mesher) -> Result<T> for each column, with that
/// column's mesher.
template <class Measure>
auto both_columns(const twin::TwinOptions& options, Measure&& measure) {
  using T =
      typename std::invoke_result_t<Measure, const VirtualSession&, SessionOptions, MeshMethod>::value_type;
  using Answer = Result<Columns<T>>;
  auto session = VirtualSession::render(options);
  if (!session) return Answer(tl::unexpected(session.error()));
  auto plain = measure(*session, thesis_session(), kThesisMesh);
  if (!plain) return Answer(tl::unexpected(plain.error()));
  auto better = measure(*session, better_session(), kBetterMesh);
  if (!better) return Answer(tl::unexpected(better.error()));
  return Answer(Columns<T>{std::move(*plain), std::move(*better)});
}

}  // namespace linescope::evaluate
