#include "acquire/tracker/liberty/liberty_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "acquire/tracker/liberty/error_words.hpp"

namespace linescope {
namespace {

constexpr Nanoseconds kReadSlice = 50 * kMillisecond;
constexpr std::size_t kMostPerChunk = 1024;  // a transfer holds some hundred records
constexpr int kMostRestarts = 2;             // on the open line; then it is closed and opened again

std::string reason_for(const StationFigures& figures) {
  if (is_error(figures.error)) return std::string(error_words(figures.error));
  switch (figures.state) {
    case ToolState::ok:
      return figures.minor_distortion ? "minor distortion: metal near by" : "";
    case ToolState::distorted_field:
      return "significant distortion: metal near by";
    case ToolState::missing:
      return "the sensor is unplugged or delivers no pose";
    case ToolState::disconnected:
      return "the LIBERTY is disconnected";
    default:
      return std::string(name(figures.state));
  }
}

bool same(const StationFigures& a, const StationFigures& b) {
  return a.state == b.state && a.error == b.error && a.minor_distortion == b.minor_distortion &&
         a.silent == b.silent;
}

}  // namespace

LibertySource::LibertySource(const LibertyOptions& options)
    : LibertySource(options, make_transport(options)) {}

LibertySource::LibertySource(const LibertyOptions& options, std::unique_ptr<ByteTransport> transport)
    : options_(options), transport_(std::move(transport)), stream_(options) {
  fresh_.reserve(kMostPerChunk);
}

LibertySource::~LibertySource() {
  stop();
}

std::string LibertySource::description() const {
  return "Polhemus LIBERTY, " + transport_->description();
}

Result<void> LibertySource::start() {
  if (thread_.joinable()) return fail(ErrorCode::usage, "LIBERTY: start() was called twice");
  if (auto valid = validate(options_); !valid) return valid;
  auto ready = transport_->open();
  if (ready) ready = start_unit();
  if (!ready) {
    transport_->close();
    if (options_.required_at_start) return ready;
    say(false, ready.error().message);
  }
  stopping_ = false;
  thread_ = std::thread([this] { run(); });
  return {};
}

void LibertySource::stop() {
  stopping_ = true;
  if (!thread_.joinable()) return;
  thread_.join();
  if (streaming_) stop_liberty(*transport_);
  streaming_ = false;
  transport_->close();
}

Result<Pull> LibertySource::next(PoseSample& out) {
  if (!queue_.pop(out, kReadSlice)) return Pull::nothing_yet;
  ledger_.count(out);
  return Pull::item;
}

TrackerCounters LibertySource::counters() const {
  TrackerCounters counters = ledger_.counters();
  counters.queue_overruns = queue_.overruns();
  return counters;
}

void LibertySource::run() {
  while (!stopping_) {
    if (streaming_)
      read_stream();
    else
      find_unit();
  }
}

void LibertySource::find_unit() {
  auto ready = transport_->open();
  if (ready) ready = start_unit();
  if (ready) return;
  transport_->close();
  say(false, ready.error().message);
  transport_->wait_for_change(options_.retry_after);
}

Result<void> LibertySource::start_unit() {
  auto identity = start_liberty(*transport_, options_);
  if (!identity) return tl::unexpected(identity.error());
  identity_ = std::move(*identity);
  stream_.restart();
  streaming_ = true;
  first_bytes_pending_ = true;
  silent_for_ = 0;
  std::string sentence = fmt::format("LIBERTY on {}: {} sensor(s), {} Hz", transport_->description(),
                                     std::popcount(identity_.detected), options_.rate_hz);
  for (const std::string& remark : identity_.remarks) sentence += "; " + remark;
  say(true, sentence);
  return {};
}

void LibertySource::read_stream() {
  const Nanoseconds begin = monotonic_now();
  const auto chunk = transport_->read(kReadSlice);
  if (!chunk) return lose_unit(chunk.error());
  if (chunk->bytes.empty()) return handle_silence(monotonic_now() - begin);
  silent_for_ = 0;
  failed_restarts_ = 0;
  if (std::exchange(first_bytes_pending_, false)) ++starts_;
  stream_.feed(chunk->bytes, chunk->arrival, *this);
  hand_over();
}

/// The button of a stylus, a reset, the last sensor unplugged: ask the unit again rather than wait for ever.
/// A process that was stopped itself did not listen: a wait counts for no more than it was meant to take.
void LibertySource::handle_silence(Nanoseconds listened) {
  silent_for_ += std::min(listened, kReadSlice);
  if (silent_for_ < options_.silence_limit) return;
  stream_.fall_silent(ToolState::missing, monotonic_now(), *this);
  hand_over();
  if (failed_restarts_ >= kMostRestarts)
    return lose_unit(
        {ErrorCode::timeout, fmt::format("LIBERTY on {}: it does not answer any more; {}",
                                         transport_->description(), transport_->silence_hint())});
  say(false, fmt::format("LIBERTY on {}: it fell silent and is started again", transport_->description()));
  const auto started = start_unit();
  if (started) {
    if (identity_.detected == 0)
      say(false, fmt::format("LIBERTY on {}: no sensor is plugged in", transport_->description()));
    return;
  }
  ++failed_restarts_;
  if (started.error().code == ErrorCode::gone) return lose_unit(started.error());
  say(false, started.error().message);
}

void LibertySource::lose_unit(const Error& error) {
  streaming_ = false;
  failed_restarts_ = 0;
  transport_->close();
  say(false, error.message);
  stream_.fall_silent(ToolState::disconnected, monotonic_now(), *this);
  hand_over();
}

void LibertySource::say(bool delivering, std::string sentence) {
  ledger_.edit([&](TrackerLedger::Books& books) {
    books.status.delivering = delivering;
    books.status.sentence = std::move(sentence);
  });
}

void LibertySource::on_message(std::uint8_t error, std::string_view text) {
  const auto words = error_words(error);
  say(streaming_, fmt::format("LIBERTY on {}: it reports {}{}", transport_->description(),
                              words.empty() ? "a message: " : words, words.empty() ? text : ""));
}

/// States first: who takes a sample and asks for its station's state gets no older one.
void LibertySource::hand_over() {
  publish();
  for (const PoseSample& sample : fresh_) queue_.push(sample);
  fresh_.clear();
}

void LibertySource::publish() {
  const StreamCounters now = stream_.counters();
  const FrameClockFigures clock = stream_.clock();
  const std::uint64_t faults = transport_->faults();
  ledger_.edit([&](TrackerLedger::Books& books) {
    TrackerCounters& out = books.counters;
    out.lost = now.lost;
    out.bad_records = now.parser.bad_records + now.doubtful_counts;
    out.resyncs = now.parser.resyncs;
    out.skipped_bytes = now.parser.skipped_bytes;
    out.out_of_order = now.out_of_order;
    out.device_errors = now.device_errors;
    out.transfer_faults = faults;
    out.reconnects = starts_ > 1 ? starts_ - 1 : 0;
    books.status.rate_hz = clock.rate_hz;
    books.status.clock_residual = clock.fit_residual;
    for (int i = 0; i < kMaxStations; ++i) publish_station(i, books.stations[static_cast<std::size_t>(i)]);
  });
}

void LibertySource::publish_station(int station, StationStatus& status) {
  const StationFigures& now = stream_.station(station);
  status.lost = now.lost;
  StationFigures& before = published_[static_cast<std::size_t>(station)];
  if (same(before, now)) return;
  before = now;
  status.state = now.state;
  status.reason = reason_for(now);
}

}  // namespace linescope
