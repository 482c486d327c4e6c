#include "tests/fuzz/tracker/liberty_target.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

#include "acquire/tracker/liberty/ascii_parser.hpp"
#include "acquire/tracker/liberty/binary_parser.hpp"
#include "acquire/tracker/liberty/liberty_stream.hpp"

namespace linescope::testing {
namespace {

using Input = std::span<const std::uint8_t>;

constexpr std::size_t kRecord = 52;
constexpr std::size_t kMostBuffered = 8 + 1024;  // the longest answer there is

class Accountant : public LibertySink {
 public:
  void on_reading(const LibertyReading& reading) override {
    ++readings;
    bytes += kRecord;
    last_frame = reading.frame_count;
    if (!reading.has_pose) return;
    if (!reading.position_mm.allFinite() || std::abs(reading.rotation.norm() - 1) > 1e-3) insane = true;
  }
  void on_answer(const LibertyAnswer& answer) override { bytes += 8 + answer.body.size(); }

  std::size_t readings = 0;
  std::size_t bytes = 0;
  std::uint32_t last_frame = 0;
  bool insane = false;
};

class RisingTimes : public SampleSink {
 public:
  void on_sample(const PoseSample& sample) override {
    auto [last, first] = last_.try_emplace(sample.station, sample.time);
    if (!first && sample.time <= last->second) broken = true;
    last->second = sample.time;
    if (usable(sample.state) && !sample.world_from_sensor.finite()) broken = true;
  }
  void on_message(std::uint8_t, std::string_view) override {}
  bool broken = false;

 private:
  std::map<int, Nanoseconds> last_;
};

std::string good_record(bool text, std::uint32_t frame) {
  if (text)
    return "\r\n01  " + std::to_string(frame) +
           " 7 0 0 1.000 2.000 3.000 1.00000 0.00000 0.00000 0.00000 \r\n";
  std::string record(
      "LY\x01"
      "C\x00\x00\x2c\x00",
      8);
  const float one = 1;
  const auto add = [&record](const void* p) { record.append(static_cast<const char*>(p), 4); };
  const std::uint32_t zero = 0;
  add(&frame);
  for (int i = 0; i < 6; ++i) add(&zero);
  add(&one);
  for (int i = 0; i < 3; ++i) add(&zero);
  return record;
}

Input bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

template <class Feed>
void in_chunks(Input stream, std::size_t size, Feed feed) {
  for (std::size_t at = 0; at < stream.size(); at += size)
    feed(stream.subspan(at, std::min(size, stream.size() - at)));
}

std::optional<std::string> check_parser(LibertyParser& parser, bool text, Input stream, std::size_t chunk) {
  Accountant found;
  in_chunks(stream, chunk, [&](Input part) { parser.feed(part, found); });
  if (found.insane) return "a pose that is no pose was handed on";
  if (!text) {
    const std::size_t accounted = found.bytes + parser.counters().skipped_bytes;
    if (accounted > stream.size()) return "more bytes were used than came";
    if (stream.size() - accounted > kMostBuffered) return "bytes were swallowed";
  }
  return std::nullopt;
}

std::optional<std::string> check_recovery(LibertyParser& parser, bool text, std::size_t chunk) {
  Accountant found;
  for (const std::uint32_t frame : {4000000001U, 4000000002U})
    in_chunks(bytes_of(good_record(text, frame)), chunk, [&](Input part) { parser.feed(part, found); });
  if (found.last_frame != 4000000002U) return "the second whole record behind the damage was not accepted";
  return std::nullopt;
}

std::optional<std::string> check_stream(bool text, Input stream, std::size_t chunk) {
  LibertyOptions options;
  options.format = text ? LibertyFormat::ascii : LibertyFormat::binary;
  LibertyStream whole(options);
  RisingTimes times;
  Nanoseconds arrival = kSecond;
  in_chunks(stream, chunk, [&](Input part) { whole.feed(part, arrival += kMillisecond, times); });
  if (times.broken) return "times of a station do not rise, or a good sample has no pose";
  return std::nullopt;
}

}  // namespace

std::optional<std::string> broken_promise(Input input) {
  if (input.empty()) return std::nullopt;
  const bool text = (input[0] & 1) != 0;
  const Expecting expecting = (input[0] & 2) != 0 ? Expecting::answers : Expecting::poses;
  const std::size_t chunk = 1 + static_cast<std::size_t>(input[0] >> 2) * 8;
  const Input stream = input.subspan(1);
  LibertyOptions options;
  options.format = text ? LibertyFormat::ascii : LibertyFormat::binary;
  BinaryParser binary(OutputList::for_options(options), expecting);
  AsciiParser ascii(OutputList::for_options(options));
  LibertyParser& parser = text ? static_cast<LibertyParser&>(ascii) : binary;
  if (auto broken = check_parser(parser, text, stream, chunk)) return broken;
  if (expecting == Expecting::poses)
    if (auto broken = check_recovery(parser, text, chunk)) return broken;
  return check_stream(text, stream, chunk);
}

}  // namespace linescope::testing
