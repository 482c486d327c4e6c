// How much faster than the device the way of its samples is, on one core. Eight sensors at 240 Hz; a second
// of it is one iteration, so 1 / (seconds per iteration) is the factor beside real time ("x_real_time").
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <string>

#include "acquire/tracker/liberty/ascii_parser.hpp"
#include "acquire/tracker/liberty/binary_parser.hpp"
#include "acquire/tracker/liberty/liberty_stream.hpp"
#include "acquire/tracker/pose_history.hpp"
#include "tests/unit/tracker/liberty_bytes.hpp"

namespace linescope {
namespace {

using testing::Bytes;

constexpr int kStations = 8;
constexpr std::uint32_t kCycles = 240;
constexpr std::size_t kChunk = 416;  // one cycle

testing::Wire wire_at(int station, std::uint32_t frame) {
  const float angle = 0.01F * static_cast<float>(frame);
  return {.station = station,
          .frame = frame,
          .position = {10 * std::sin(angle), 2, 3},
          .quaternion = {std::cos(angle), 0, std::sin(angle), 0}};
}

Bytes binary_second(std::uint32_t first) {
  Bytes bytes;
  for (std::uint32_t frame = first; frame < first + kCycles; ++frame)
    for (int station = 1; station <= kStations; ++station)
      testing::append(bytes, testing::pose_bytes(wire_at(station, frame)));
  return bytes;
}

Bytes ascii_second() {
  std::string text;
  for (std::uint32_t frame = 0; frame < kCycles; ++frame)
    for (int station = 1; station <= kStations; ++station) {
      const auto w = wire_at(station, frame);
      std::array<char, 160> line;
      const int n = std::snprintf(line.data(), line.size(),
                                  "%02d  %u %u 0 0 %8.3f %8.3f %8.3f %8.5f %8.5f %8.5f %8.5f \r\n", station,
                                  frame, frame * 1000 / 240, w.position[0], w.position[1], w.position[2],
                                  w.quaternion[0], w.quaternion[1], w.quaternion[2], w.quaternion[3]);
      text.append(line.data(), static_cast<std::size_t>(n));
    }
  return testing::bytes_of(text);
}

void report(benchmark::State& state, std::size_t bytes) {
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(bytes));
  state.counters["x_real_time"] =
      benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

class Counting : public LibertySink {
 public:
  void on_reading(const LibertyReading& reading) override { sum += reading.frame_count; }
  void on_answer(const LibertyAnswer&) override {}
  std::uint64_t sum = 0;
};

void feed(LibertyParser& parser, const Bytes& bytes, LibertySink& sink) {
  for (std::size_t at = 0; at < bytes.size(); at += kChunk)
    parser.feed(std::span(bytes).subspan(at, std::min(kChunk, bytes.size() - at)), sink);
}

void parse_binary(benchmark::State& state) {
  const Bytes bytes = binary_second(0);
  BinaryParser parser(OutputList::for_options({}), Expecting::poses);
  Counting sink;
  for (auto _ : state) feed(parser, bytes, sink);
  benchmark::DoNotOptimize(sink.sum);
  report(state, bytes.size());
}
BENCHMARK(parse_binary);

void parse_ascii(benchmark::State& state) {
  const Bytes bytes = ascii_second();
  LibertyOptions options;
  options.format = LibertyFormat::ascii;
  AsciiParser parser(OutputList::for_options(options));
  Counting sink;
  for (auto _ : state) feed(parser, bytes, sink);
  benchmark::DoNotOptimize(sink.sum);
  report(state, bytes.size());
}
BENCHMARK(parse_ascii);

/// A worst case: nothing but bytes that look like the beginning of a record.
void parse_garbage(benchmark::State& state) {
  Bytes bytes(kStations * kCycles * 52);
  for (std::size_t i = 0; i < bytes.size(); ++i)
    bytes[i] =
        "LY\x01"
        "C\0\0\x2c\0"[i % 8];
  BinaryParser parser(OutputList::for_options({}), Expecting::poses);
  Counting sink;
  for (auto _ : state) feed(parser, bytes, sink);
  report(state, bytes.size());
}
BENCHMARK(parse_garbage);

class IntoHistory : public SampleSink {
 public:
  void on_sample(const PoseSample& sample) override { history.add(sample); }
  void on_message(std::uint8_t, std::string_view) override {}
  PoseHistory history;
};

/// Bytes to history: parsing, frame clock, station states, ring.
void bytes_to_history(benchmark::State& state) {
  Bytes bytes = binary_second(0);
  LibertyStream stream{LibertyOptions{}};
  IntoHistory sink;
  std::uint32_t frame = 0;
  Nanoseconds arrival = kSecond;
  for (auto _ : state) {
    for (std::size_t at = 0; at < bytes.size(); at += kChunk, ++frame) {
      for (std::size_t record = at; record < at + kChunk; record += 52)
        std::memcpy(bytes.data() + record + 8, &frame, 4);
      stream.feed(std::span(bytes).subspan(at, kChunk), arrival += 4'166'667, sink);
    }
  }
  report(state, bytes.size());
}
BENCHMARK(bytes_to_history);

/// The floor: the same bytes copied once.
void copy_bytes(benchmark::State& state) {
  const Bytes bytes = binary_second(0);
  Bytes target(bytes.size());
  for (auto _ : state) {
    std::memcpy(target.data(), bytes.data(), bytes.size());
    benchmark::DoNotOptimize(target.data());
    benchmark::ClobberMemory();
  }
  report(state, bytes.size());
}
BENCHMARK(copy_bytes);

void pose_at(benchmark::State& state) {
  PoseHistory history;
  PoseSample sample;
  sample.state = ToolState::ok;
  for (int i = 0; i < 2048; ++i) {
    sample.time = i * 4'166'667LL;
    sample.world_from_sensor = {Eigen::Quaterniond(Eigen::AngleAxisd(0.01 * i, Eigen::Vector3d::UnitZ())),
                                {1.0 * i, 0, 0}};
    history.add(sample);
  }
  Nanoseconds t = 0;
  for (auto _ : state) {
    t = (t + 1'234'567'891) % (2047 * 4'166'667LL);
    benchmark::DoNotOptimize(history.pose_at(0, t));
  }
}
BENCHMARK(pose_at);

}  // namespace
}  // namespace linescope
