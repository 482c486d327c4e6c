// The scripted LIBERTY's records: a measuring cycle in binary or in text, and its way into packets.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "tests/integration/tracker/fake/byte_append.hpp"
#include "tests/integration/tracker/fake/fake_liberty.hpp"

namespace linescope::testing {
namespace {

constexpr std::size_t kFifo = 2300;  // bytes the unit keeps for a host that does not read

}  // namespace

FakeLiberty::Bytes FakeLiberty::frame(int station, std::uint8_t command, std::uint8_t error,
                                      const Bytes& body) const {
  Bytes out(8 + body.size());
  const auto size = static_cast<std::int16_t>(body.size());
  out[0] = static_cast<std::uint8_t>(tag_[0]);
  out[1] = static_cast<std::uint8_t>(tag_[1]);
  out[2] = static_cast<std::uint8_t>(station);
  out[3] = command;
  out[4] = error;
  std::memcpy(out.data() + 6, &size, sizeof size);
  std::copy(body.begin(), body.end(), out.begin() + 8);
  return out;
}

void FakeLiberty::make_cycle(std::uint8_t command) {
  for (int station = 0; station < static_cast<int>(sensors_.size()); ++station) {
    if (!sensors_[static_cast<std::size_t>(station)].plugged || ((settings_.active >> station) & 1) == 0)
      continue;
    if (settings_.binary)
      append_binary(collected_, station, command);
    else
      append_ascii(collected_, station);
  }
}

void FakeLiberty::append_binary(Bytes& out, int station, std::uint8_t command) const {
  const FakeSensor& sensor = sensors_[static_cast<std::size_t>(station)];
  const auto p = pose(station, frame_);
  const float unit = settings_.centimetres ? 1.0F : 1 / 2.54F;
  Bytes body;
  for (const int item : settings_.items) {
    switch (item) {
      case 0:
        body.push_back(' ');
        break;
      case 1:
        body.insert(body.end(), {'\r', '\n'});
        break;
      case 2:
      case 3:
        for (std::size_t i = 0; i < 3; ++i) append(body, p[i] * unit);
        break;
      case 4:
      case 5:
        for (int i = 0; i < 3; ++i) append(body, 10.0F);
        break;
      case 7:
        for (std::size_t i = 3; i < 7; ++i) append(body, p[i]);
        break;
      case 8:
        append(body, static_cast<std::uint32_t>(frame_ * 1000ULL / (settings_.rate == 3 ? 120 : 240)));
        break;
      case 9:
        append(body, frame_);
        break;
      case 11:
        append(body, std::int32_t{sensor.distortion});
        break;
      default:
        append(body, std::int32_t{0});
        break;
    }
  }
  const Bytes record = frame(station + 1, command, sensor.error, body);
  out.insert(out.end(), record.begin(), record.end());
}

void FakeLiberty::append_ascii(Bytes& out, int station) const {
  const FakeSensor& sensor = sensors_[static_cast<std::size_t>(station)];
  const auto p = pose(station, frame_);
  const float unit = settings_.centimetres ? 1.0F : 1 / 2.54F;
  std::string line =
      fmt::format("{:02}{} ", station + 1, sensor.error == 0 ? ' ' : static_cast<char>(sensor.error));
  for (const int item : settings_.items) {
    switch (item) {
      case 1:
        line += "\r\n";
        break;
      case 2:
      case 3:
        line += fmt::format("{:8.3f} {:8.3f} {:8.3f} ", p[0] * unit, p[1] * unit, p[2] * unit);
        break;
      case 4:
      case 5:
        line += fmt::format("{:8.3f} {:8.3f} {:8.3f} ", 10.0, 20.0, 30.0);
        break;
      case 7:
        line += fmt::format("{:8.5f} {:8.5f} {:8.5f} {:8.5f} ", p[3], p[4], p[5], p[6]);
        break;
      case 8:
        line += fmt::format("{} ", frame_ * 1000ULL / (settings_.rate == 3 ? 120 : 240));
        break;
      case 9:
        line += fmt::format("{} ", frame_);
        break;
      case 11:
        line += fmt::format("{} ", sensor.distortion);
        break;
      default:
        line += "0 ";
        break;
    }
  }
  out.insert(out.end(), line.begin(), line.end());
}

void FakeLiberty::flush_cycle() {
  collected_cycles_ = 0;
  if (!collected_.empty()) send(std::exchange(collected_, {}));
}

/// What does not fit into the buffer is lost, whole sends at a time; in newest-only mode the older ones give
/// way.
void FakeLiberty::send(const Bytes& bytes) {
  std::size_t waiting = 0;
  for (const Bytes& packet : packets_) waiting += packet.size();
  if (!settings_.fifo && streaming_)
    packets_.clear();
  else if (waiting + bytes.size() > kFifo) {
    fifo_dropped_ += bytes.size();
    return;
  }
  for (std::size_t at = 0; at < bytes.size(); at += longest_packet_) {
    const std::size_t end = std::min(bytes.size(), at + longest_packet_);
    packets_.emplace_back(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                          bytes.begin() + static_cast<std::ptrdiff_t>(end));
  }
}

}  // namespace linescope::testing
