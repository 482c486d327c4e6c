#include "ipc/segment_types.hpp"

#include "ipc/control.hpp"
#include "ipc/segment_reader.hpp"
#include "ipc/segment_writer.hpp"

namespace linescope {

std::string_view name(DaemonState state) {
  switch (state) {
    case DaemonState::starting:
      return "starting";
    case DaemonState::idle:
      return "idle";
    case DaemonState::scanning:
      return "scanning";
    case DaemonState::full:
      return "full";
    case DaemonState::camera_lost:
      return "camera lost";
    case DaemonState::tracker_lost:
      return "tracker lost";
    case DaemonState::stopping:
      return "stopping";
  }
  return "unknown";
}

std::string_view name(SensorRole role) {
  switch (role) {
    case SensorRole::none:
      return "none";
    case SensorRole::endoscope:
      return "endoscope";
    case SensorRole::object:
      return "object";
    case SensorRole::harvester:
      return "harvester";
    case SensorRole::other:
      return "other";
  }
  return "unknown";
}

std::string_view name(Counter counter) {
  switch (counter) {
#define LINESCOPE_NAME(word) \
  case Counter::word:        \
    return #word;
    LS_COUNTERS(LINESCOPE_NAME)
#undef LINESCOPE_NAME
  }
  return "unknown";
}

std::string_view name(LatencyStage stage) {
  switch (stage) {
#define LINESCOPE_NAME(word) \
  case LatencyStage::word:   \
    return #word;
    LS_LATENCIES(LINESCOPE_NAME)
#undef LINESCOPE_NAME
  }
  return "unknown";
}

std::string_view name(PublishOutcome outcome) {
  switch (outcome) {
    case PublishOutcome::stored:
      return "stored";
    case PublishOutcome::full:
      return "full";
    case PublishOutcome::not_scanning:
      return "not scanning";
    case PublishOutcome::invalid:
      return "invalid";
  }
  return "unknown";
}

std::string_view name(Life life) {
  switch (life) {
    case Life::live:
      return "live";
    case Life::silent:
      return "silent";
    case Life::closed:
      return "closed";
    case Life::replaced:
      return "replaced";
    case Life::removed:
      return "removed";
    case Life::damaged:
      return "damaged";
  }
  return "unknown";
}

std::string_view name(ReadOutcome outcome) {
  switch (outcome) {
    case ReadOutcome::ok:
      return "ok";
    case ReadOutcome::nothing:
      return "nothing";
    case ReadOutcome::overtaken:
      return "overtaken";
    case ReadOutcome::corrupt:
      return "corrupt";
  }
  return "unknown";
}

std::string_view name(CommandKind kind) {
  switch (kind) {
    case CommandKind::start:
      return "start";
    case CommandKind::stop:
      return "stop";
    case CommandKind::clear:
      return "clear";
    case CommandKind::new_scan:
      return "new scan";
    case CommandKind::undo_sweep:
      return "undo sweep";
    case CommandKind::save:
      return "save";
    case CommandKind::exposure:
      return "exposure";
    case CommandKind::laser_brightness:
      return "laser brightness";
    case CommandKind::shut_down:
      return "shut down";
  }
  return "unknown";
}

std::string_view name(AnswerKind kind) {
  switch (kind) {
    case AnswerKind::pending:
      return "pending";
    case AnswerKind::done:
      return "done";
    case AnswerKind::refused:
      return "refused";
    case AnswerKind::unknown:
      return "unknown";
    case AnswerKind::lost:
      return "lost";
  }
  return "unknown";
}

}  // namespace linescope
