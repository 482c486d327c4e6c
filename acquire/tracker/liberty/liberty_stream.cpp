#include "acquire/tracker/liberty/liberty_stream.hpp"

#include <algorithm>

#include "acquire/tracker/liberty/ascii_parser.hpp"
#include "acquire/tracker/liberty/binary_parser.hpp"
#include "acquire/tracker/liberty/error_words.hpp"

namespace linescope {
namespace {

std::unique_ptr<LibertyParser> parser_for(const LibertyOptions& options) {
  const OutputList list = OutputList::for_options(options);
  if (options.format == LibertyFormat::ascii) return std::make_unique<AsciiParser>(list);
  return std::make_unique<BinaryParser>(list, Expecting::poses);
}

}  // namespace

LibertyStream::LibertyStream(const LibertyOptions& options)
    : options_(options),
      parser_(parser_for(options)),
      sequence_({.nominal_hz = static_cast<double>(options.rate_hz), .latency = options.device_latency}) {}

void LibertyStream::feed(std::span<const std::uint8_t> bytes, Nanoseconds arrival, SampleSink& sink) {
  arrival_ = arrival;
  sink_ = &sink;
  parser_->feed(bytes, *this);
  sink_ = nullptr;
}

void LibertyStream::restart() {
  parser_->reset();
  sequence_.reset();
}

void LibertyStream::fall_silent(ToolState state, Nanoseconds now, SampleSink& sink) {
  sink_ = &sink;
  cycle_time_ = std::max(now, cycle_time_ + 1);
  for (int i = 0; i < kMaxStations; ++i) {
    const ToolState before = station(i).state;
    if (before != ToolState::never_seen && before != state) report_silent(i, state, 0, now);
  }
  sink_ = nullptr;
}

/// Every station ever seen is waited for again, so that one which stays away is reported.
void LibertyStream::begin_epoch() {
  ++counters_.epochs;
  for (Station& station : stations_) {
    station.expected =
        station.figures.state != ToolState::never_seen && station.figures.state != ToolState::missing;
    station.last_frame = -1;
    station.last_cycle = cycle_;
  }
}

void LibertyStream::on_reading(const LibertyReading& reading) {
  if (reading.station >= kMaxStations) return;
  if (is_error(reading.error)) ++counters_.device_errors;
  std::int64_t frame = 0;
  const auto verdict = sequence_.accept(reading.frame_count, arrival_, frame);
  if (verdict == FrameSequence::Verdict::doubtful) {
    ++counters_.doubtful_counts;
    return;
  }
  if (verdict == FrameSequence::Verdict::new_epoch) begin_epoch();
  Station& station = stations_[reading.station];
  if (frame > cycle_frame_ || verdict == FrameSequence::Verdict::new_epoch) begin_cycle(frame);
  if (frame != cycle_frame_ || !count_losses(station, frame)) {
    ++counters_.out_of_order;
    return;
  }
  station.expected = true;
  station.last_frame = frame;
  station.last_cycle = cycle_;
  station.figures.error = reading.error;
  station.figures.minor_distortion = reading.distortion == 1;
  station.figures.silent = false;
  PoseSample sample;
  sample.frame_count = reading.frame_count;
  sample.station = reading.station;
  sample.state = state_of(reading);
  if (reading.has_pose) sample.world_from_sensor = {reading.rotation, reading.position_mm};
  if (reading.distortion >= 0) sample.distortion = static_cast<float>(reading.distortion);
  sample.arrival = arrival_;
  emit(station, sample);
  find_missing(reading.frame_count);
}

/// All records of a cycle share one time, later than the cycle before and never later than their arrival
/// allows.
void LibertyStream::begin_cycle(std::int64_t frame) {
  cycle_frame_ = frame;
  ++cycle_;
  const Nanoseconds mapped = std::min(sequence_.clock().time_of(frame), arrival_ - options_.device_latency);
  cycle_time_ = std::max(mapped, cycle_time_ + 1);
}

/// False when this frame of the station was already here.
bool LibertyStream::count_losses(Station& station, std::int64_t frame) {
  if (!station.expected || station.last_frame < 0) return true;
  if (frame <= station.last_frame) return false;
  const auto lost = static_cast<std::uint64_t>(frame - station.last_frame - 1);
  station.figures.lost += lost;
  counters_.lost += lost;
  return true;
}

void LibertyStream::find_missing(std::uint32_t count) {
  for (int i = 0; i < kMaxStations; ++i) {
    Station& station = stations_[static_cast<std::size_t>(i)];
    if (!station.expected || cycle_ - station.last_cycle < options_.missing_after) continue;
    station.expected = false;
    report_silent(i, ToolState::missing, count, arrival_);
  }
}

void LibertyStream::report_silent(int station, ToolState state, std::uint32_t count, Nanoseconds arrival) {
  Station& it = stations_[static_cast<std::size_t>(station)];
  it.figures.error = 0;
  it.figures.minor_distortion = false;
  it.figures.silent = true;
  PoseSample sample;
  sample.frame_count = count;
  sample.station = static_cast<std::uint8_t>(station);
  sample.state = state;
  sample.arrival = arrival;
  emit(it, sample);
}

void LibertyStream::emit(Station& station, PoseSample sample) {
  sample.time = std::max(cycle_time_, station.last_time + 1);
  station.last_time = sample.time;
  station.figures.state = sample.state;
  sink_->on_sample(sample);
}

ToolState LibertyStream::state_of(const LibertyReading& reading) const {
  const ToolState by_error = state_for_error(reading.error);
  if (!usable(by_error) || !reading.has_pose) return usable(by_error) ? ToolState::missing : by_error;
  return reading.distortion >= options_.distortion_limit ? ToolState::distorted_field : ToolState::ok;
}

void LibertyStream::on_answer(const LibertyAnswer& answer) {
  if (is_error(answer.error)) ++counters_.device_errors;
  sink_->on_message(answer.error, {reinterpret_cast<const char*>(answer.body.data()), answer.body.size()});
}

StreamCounters LibertyStream::counters() const {
  StreamCounters all = counters_;
  all.parser = parser_->counters();
  return all;
}

}  // namespace linescope
