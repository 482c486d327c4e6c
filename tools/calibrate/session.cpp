#include "tools/calibrate/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "acquire/laser/line_extractor.hpp"
#include "tools/calibrate/content_hash.hpp"

namespace linescope::calibrate {
namespace {

/// A stepped tracker is read this far beyond the picture, so that every picture has a pose on both sides.
constexpr Nanoseconds kPosesAhead = kSecond;
constexpr auto kNap = std::chrono::milliseconds(5);

/// One run through an input.
class Collector {
 public:
  Collector(Input& input, const CollectOptions& options) : input_(input), options_(options) {
    if (options.board) finder_.emplace(*options.board);
    if (options.line) extractor_.emplace(*options.line);
    session_.stations = input.stations;
    session_.calibration = input.calibration;
    session_.description = input.description;
  }

  Result<Session> run(const Progress& progress) {
    if (auto ok = start(); !ok) return tl::unexpected(ok.error());
    if (auto ok = wants_pictures() ? pictures(progress) : poses_only(progress); !ok)
      return tl::unexpected(ok.error());
    for (const auto& samples : session_.poses) add_to_hash(samples);
    session_.hash = hash_.value();
    return std::move(session_);
  }

 private:
  Result<void> start() {
    if (!input_.camera && !input_.tracker)
      return fail(ErrorCode::usage, "neither pictures nor poses were given");
    if (wants_pictures())
      if (auto ok = input_.camera->start(); !ok) return ok;
    if (input_.tracker)
      if (auto ok = input_.tracker->start(); !ok) return ok;
    began_ = monotonic_now();
    return {};
  }

  bool wants_pictures() const { return input_.camera && !(options_.poses_only && input_.tracker); }
  bool enough_poses() const {
    const int station = session_.stations.harvester;
    return options_.most_poses > 0 && station >= 0 &&
           session_.poses.at(static_cast<std::size_t>(station)).size() >= options_.most_poses;
  }
  bool time_is_over() const { return options_.longest > 0 && monotonic_now() - began_ > options_.longest; }
  bool enough() const {
    return options_.most_pictures > 0 && session_.observations.size() >= options_.most_pictures;
  }

  Result<void> pictures(const Progress& progress) {
    while (!time_is_over() && !enough()) {
      auto pulled = input_.camera->next(frame_);
      if (!pulled) {
        if (pulled.error().code != ErrorCode::unreadable) return tl::unexpected(pulled.error());
        ++session_.offered;
        session_.left_out.push_back({label(), pulled.error().message});
        continue;
      }
      if (*pulled == Pull::end) break;
      if (auto ok = poses_until(*pulled == Pull::item ? frame_.time + kPosesAhead : 0); !ok) return ok;
      if (*pulled == Pull::nothing_yet) continue;
      if (!due(frame_.time)) continue;
      if (auto ok = look_at(frame_); !ok) return ok;
      if (progress && !progress(session_, frame_)) break;
    }
    if (session_.offered == 0)
      return fail(ErrorCode::not_found, fmt::format("{}: no picture came", session_.description));
    return poses_until(frame_.time + kPosesAhead);
  }

  Result<void> poses_only(const Progress& progress) {
    frame_ = {};
    while (!time_is_over() && !enough_poses()) {
      auto pulled = next_pose();
      if (!pulled) return tl::unexpected(pulled.error());
      if (*pulled == Pull::end) break;
      if (*pulled == Pull::item) continue;
      if (progress && !progress(session_, frame_)) break;
      if (input_.tracker->live()) std::this_thread::sleep_for(kNap);
    }
    const bool any = std::any_of(session_.poses.begin(), session_.poses.end(),
                                 [](const auto& samples) { return !samples.empty(); });
    if (!any) return fail(ErrorCode::not_found, fmt::format("{}: no pose came", session_.description));
    return {};
  }

  /// Stepped: up to that time. Live: what is there.
  Result<void> poses_until(Nanoseconds time) {
    while (input_.tracker && !tracker_ended_ && (input_.tracker->live() || newest_pose_ < time)) {
      auto pulled = next_pose();
      if (!pulled) return tl::unexpected(pulled.error());
      if (*pulled != Pull::item) break;
    }
    return {};
  }

  Result<Pull> next_pose() {
    PoseSample sample;
    auto pulled = input_.tracker->next(sample);
    if (!pulled && pulled.error().code == ErrorCode::unreadable) {
      session_.left_out.push_back({"pose", pulled.error().message});
      return Pull::item;
    }
    if (!pulled) return pulled;
    if (*pulled == Pull::end) tracker_ended_ = true;
    if (*pulled != Pull::item) return pulled;
    newest_pose_ = std::max(newest_pose_, sample.time);
    if (sample.station < kMaxStations) session_.poses[sample.station].push_back(sample);
    return pulled;
  }

  bool due(Nanoseconds time) {
    if (options_.every > 0 && session_.offered > 0 && time - last_looked_ < options_.every) return false;
    last_looked_ = time;
    return true;
  }

  std::string label() const {
    return frame_.name.empty() ? fmt::format("picture {}", frame_.index) : frame_.name;
  }

  Result<void> look_at(const Frame& frame) {
    ++session_.offered;
    if (session_.width == 0) session_.width = frame.bgr.cols, session_.height = frame.bgr.rows;
    if (frame.bgr.cols != session_.width || frame.bgr.rows != session_.height)
      return fail(ErrorCode::mismatch,
                  fmt::format("{} is {}x{}, the pictures before it are {}x{}: a calibration belongs to one "
                              "camera at one picture size, sort the others out",
                              label(), frame.bgr.cols, frame.bgr.rows, session_.width, session_.height));
    hash_.add(frame.bgr);
    hash_.add(&frame.time, sizeof frame.time);
    observe(frame);
    return {};
  }

  void observe(const Frame& frame) {
    Observation seen{label(), frame.time, {}, {}};
    BoardMiss miss = BoardMiss::none;
    if (finder_) seen.board = finder_->find(frame.bgr, miss);
    if (extractor_) seen.line = extractor_->extract(frame.bgr).samples;
    if (!seen.board.empty() || !seen.line.empty()) {
      session_.observations.push_back(std::move(seen));
      return;
    }
    session_.left_out.push_back({label(), miss == BoardMiss::mirrored ? "board seen in a mirror"
                                          : finder_                   ? "no board found"
                                                                      : "no laser line found"});
    if (miss == BoardMiss::mirrored) ++session_.mirrored;
  }

  void add_to_hash(const std::vector<PoseSample>& samples) {
    for (const PoseSample& s : samples) {
      hash_.add(&s.time, sizeof s.time);
      hash_.add(s.world_from_sensor.translation().data(), 3 * sizeof(double));
      hash_.add(s.world_from_sensor.rotation().coeffs().data(), 4 * sizeof(double));
    }
  }

  Input& input_;
  const CollectOptions& options_;
  std::optional<BoardFinder> finder_;
  std::optional<LineExtractor> extractor_;
  Session session_;
  ContentHash hash_;
  Frame frame_;
  Nanoseconds began_ = 0, last_looked_ = 0, newest_pose_ = 0;
  bool tracker_ended_ = false;
};

bool before(const PoseSample& sample, Nanoseconds time) {
  return sample.time < time;
}

}  // namespace

PoseAnswer Session::pose_at(int station, Nanoseconds time, Nanoseconds latency,
                            Nanoseconds longest_gap) const {
  PoseAnswer answer;
  if (station < 0 || station >= kMaxStations) return answer;
  const auto& samples = poses[static_cast<std::size_t>(station)];
  if (samples.empty()) return answer;
  const Nanoseconds at = time - latency;
  const auto after = std::lower_bound(samples.begin(), samples.end(), at, before);
  if (after == samples.end()) return answer.miss = PoseMiss::too_late, answer;
  const bool exact = after->time == at;
  if (!exact && after == samples.begin()) return answer.miss = PoseMiss::too_early, answer;
  return pose_between(exact ? *after : *(after - 1), *after, at, longest_gap);
}

Result<Session> collect(Input& input, const CollectOptions& options, const Progress& progress) {
  return Collector(input, options).run(progress);
}

}  // namespace linescope::calibrate
