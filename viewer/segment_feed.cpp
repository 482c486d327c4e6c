#include "viewer/segment_feed.hpp"

#include <fmt/format.h>

#include <chrono>

namespace linescope {
namespace {

// Enough for any one picture, small enough that a reader that comes late shows the first lines at once.
constexpr std::size_t kPointsAtOnce = 200'000;

LinkState link_after(Life life) {
  return life == Life::damaged ? LinkState::refused : LinkState::ended;
}

bool over(Life life) {
  return life == Life::closed || life == Life::replaced || life == Life::removed || life == Life::damaged;
}

}  // namespace

Result<void> validate(const FeedOptions& options) {
  if (options.segment.empty())
    return fail(ErrorCode::usage, "--segment needs a name; the daemon's default is linescope");
  return {};
}

SegmentFeed::SegmentFeed(FeedOptions options, FeedSinks sinks)
    : options_(std::move(options)), sinks_(std::move(sinks)), memory_(LinePlacer(options_.held_in)) {
  view_.held_in = options_.held_in;
  view_.link.segment = options_.segment;
  view_.link.text = "Looking for the daemon.";
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

SegmentFeed::~SegmentFeed() = default;

void SegmentFeed::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    Nanoseconds now = monotonic_now();
    if (forget_.exchange(false)) pass_on(memory_.forget(view_.scan));
    if (!reader_) look(now);
    if (reader_) follow(now);
    courier_.run(reader_ ? &*reader_ : nullptr, now);
    publish(now);
    if (reader_)
      reader_->wait(Topic::all, options_.wake_every);
    else
      std::this_thread::sleep_for(std::chrono::nanoseconds(options_.look_every));
  }
}

void SegmentFeed::look(Nanoseconds now) {
  auto reader = SegmentReader::attach({.name = options_.segment});
  if (!reader) {
    const ErrorCode code = reader.error().code;
    const bool absent = code == ErrorCode::not_found || code == ErrorCode::busy;
    // Whoever was attached keeps the reason why it is not any more until there is something new to say.
    if (view_.link.state == LinkState::ended && absent) return;
    view_.link.state = absent ? LinkState::searching : LinkState::refused;
    view_.link.text = reader.error().message;
    return;
  }
  const SegmentIdentity& who = reader->identity();
  if (view_.link.session != who.session_id) memory_.change_session();
  view_.link.session = who.session_id;
  view_.link.pid = who.writer_pid;
  view_.link.daemon = who.program;
  reader_.emplace(std::move(*reader));
  collector_.reset();
  follow(now);
}

void SegmentFeed::follow(Nanoseconds now) {
  const LifeReport report = reader_->report(now);
  if (over(report.life)) return detach(link_after(report.life), report.text, now);
  view_.link.state = report.life == Life::live ? LinkState::attached : LinkState::silent;
  view_.link.text = report.text;
  view_.link.heartbeat = now - report.silent_for;
  if (!collector_.collect(*reader_, now, view_))
    return detach(LinkState::refused, "The segment holds impossible numbers; it is not used any more.", now);
  if (const auto& calibration = collector_.calibration())
    memory_.placer().set_camera(calibration->endoscope_from_camera);
  if (view_.link.state == LinkState::silent) LiveCollector::mark_disconnected(view_, report.text);
  read_lines();
}

void SegmentFeed::read_lines() {
  do {
    if (reader_->read_lines(cursor_, batch_, kPointsAtOnce) != ReadOutcome::ok) return;
    pass_on(memory_.take(batch_, view_.scan));
  } while (batch_.more);
}

void SegmentFeed::detach(LinkState state, const std::string& why, Nanoseconds now) {
  reader_.reset();
  view_.link.state = state;
  view_.link.text = why;
  LiveCollector::mark_disconnected(view_, why);
  courier_.hang_up(now);
}

void SegmentFeed::pass_on(LineNews news) {
  if (news.forget || !news.lines.empty()) sinks_.lines(news);
}

void SegmentFeed::publish(Nanoseconds now) {
  view_.time = now;
  sinks_.live(std::make_shared<const LiveView>(view_));
}

}  // namespace linescope
