#include "tools/studies/navigation_study_scan.hpp"

#include "acquire/twin/twin_camera.hpp"
#include "acquire/twin/twin_tracker.hpp"
#include "acquire/twin/virtual_experiment.hpp"
#include "tools/evaluate/session_run.hpp"

namespace linescope::study {
namespace {

Result<Sources> started_sources(const twin::TwinOptions& options) {
  auto experiment = twin::VirtualExperiment::create(options);
  if (!experiment) return tl::unexpected(experiment.error());
  Sources sources;
  sources.camera = std::make_unique<twin::TwinCamera>(*experiment);
  sources.tracker = std::make_unique<twin::TwinTracker>(*experiment);
  sources.calibration = (*experiment)->calibration();
  if (auto ok = sources.camera->start(); !ok) return tl::unexpected(ok.error());
  if (auto ok = sources.tracker->start(); !ok) return tl::unexpected(ok.error());
  return sources;
}

evaluate::SessionOptions session_options(const twin::TwinOptions& options, Nanoseconds mean_over) {
  evaluate::SessionOptions session;
  session.history.mean_over = mean_over;
  session.lines = static_cast<std::uint32_t>(60 * seconds_from(options.duration)) + 60;
  return session;
}

}  // namespace

Result<StudyScan> scan_twin(const twin::TwinOptions& options, Nanoseconds mean_over) {
  auto sources = started_sources(options);
  if (!sources) return tl::unexpected(sources.error());
  StudyScan result;
  result.calibration = sources->calibration;
  auto session = evaluate::run_session(std::move(*sources), session_options(options, mean_over));
  if (!session) return tl::unexpected(session.error());
  result.lines = std::move(session->lines);
  return result;
}

}  // namespace linescope::study
