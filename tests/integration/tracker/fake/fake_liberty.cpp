#include "tests/integration/tracker/fake/fake_liberty.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <utility>

namespace linescope::testing {
namespace {

constexpr std::size_t kFifo = 2300;  // bytes the unit keeps for a host that does not read
constexpr int kMostStations = 8;

template <class T>
void append(std::vector<std::uint8_t>& out, T value) {
  std::array<std::uint8_t, sizeof(T)> bytes;
  std::memcpy(bytes.data(), &value, sizeof value);
  out.insert(out.end(), bytes.begin(), bytes.end());
}

template <class Container>
std::vector<std::uint8_t> packed(const Container& values) {
  std::vector<std::uint8_t> out;
  for (const auto value : values) append(out, value);
  return out;
}

std::vector<double> numbers_after(const std::string& command, std::size_t start) {
  std::vector<double> values;
  for (std::size_t at = start; at < command.size();) {
    const std::size_t comma = std::min(command.find(',', at), command.size());
    const std::string part = command.substr(at, comma - at);
    values.push_back(part == "*" || part.empty() ? 0 : std::stod(part));
    at = comma + 1;
  }
  return values;
}

std::vector<std::uint8_t> bytes_from(const std::string& text) {
  return {text.begin(), text.end()};
}

std::string readable(const std::string& command) {
  std::string text;
  for (const char c : command)
    text += c < ' ' ? std::string{'^', static_cast<char>(c + '@')} : std::string(1, c);
  return text;
}

}  // namespace

FakeLiberty::FakeLiberty(int sensors) : sensors_(kMostStations) {
  for (int i = 0; i < sensors; ++i) sensors_[static_cast<std::size_t>(i)].plugged = true;
}

std::array<float, 7> FakeLiberty::pose(int station, std::uint32_t frame) {
  const float angle = 0.01F * static_cast<float>(frame % 1000) + 0.3F * static_cast<float>(station);
  return {10.0F * std::sin(angle) + static_cast<float>(station),
          2.5F,
          -7.25F,
          std::cos(angle / 2),
          0,
          0,
          std::sin(angle / 2)};
}

void FakeLiberty::receive(std::span<const std::uint8_t> bytes) {
  const std::lock_guard lock(mutex_);
  for (const std::uint8_t byte : bytes) {
    const char c = static_cast<char>(byte);
    if (settings_.echo) packets_.push_back({byte});
    if ((c == 'P' || c == 'p') && typed_.empty()) {
      commands_.emplace_back("P");
      if (streaming_)
        streaming_ = false;
      else
        make_cycle('P');
      flush_cycle();
    } else if (c == '\r') {
      execute(std::exchange(typed_, {}));
    } else {
      typed_ += c;
    }
  }
}

std::optional<std::vector<std::uint8_t>> FakeLiberty::next_packet() {
  const std::lock_guard lock(mutex_);
  if (packets_.empty()) return std::nullopt;
  Bytes packet = std::move(packets_.front());
  packets_.pop_front();
  if (bytes_to_drop_ > 0 && packet.size() > 60) {
    const auto middle = packet.begin() + 30;
    packet.erase(middle, middle + std::exchange(bytes_to_drop_, 0));
  }
  return packet;
}

void FakeLiberty::run_cycles(int count) {
  const std::lock_guard lock(mutex_);
  for (int i = 0; i < count; ++i) {
    ++frame_;
    if (!streaming_) continue;
    ++cycles_sent_;
    make_cycle('C');
    if (++collected_cycles_ >= cycles_per_packet_) flush_cycle();
  }
}

void FakeLiberty::lose_cycles(int count) {
  const std::lock_guard lock(mutex_);
  frame_ += static_cast<std::uint32_t>(count);
}

void FakeLiberty::plug(int station, bool plugged) {
  const std::lock_guard lock(mutex_);
  sensors_[static_cast<std::size_t>(station)].plugged = plugged;
}

void FakeLiberty::set_error(int station, std::uint8_t error) {
  const std::lock_guard lock(mutex_);
  sensors_[static_cast<std::size_t>(station)].error = error;
}

void FakeLiberty::set_distortion(int station, int level) {
  const std::lock_guard lock(mutex_);
  sensors_[static_cast<std::size_t>(station)].distortion = level;
}

void FakeLiberty::inject(std::span<const std::uint8_t> bytes) {
  const std::lock_guard lock(mutex_);
  collected_.insert(collected_.end(), bytes.begin(), bytes.end());
}

void FakeLiberty::inject(const std::string& bytes) {
  inject({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
}

void FakeLiberty::drop_bytes(int count) {
  const std::lock_guard lock(mutex_);
  bytes_to_drop_ = count;
}

void FakeLiberty::set_packets(std::size_t longest, int cycles_per_packet) {
  const std::lock_guard lock(mutex_);
  longest_packet_ = longest == 0 ? 512 : longest;
  cycles_per_packet_ = cycles_per_packet;
}

void FakeLiberty::go_quiet() {
  const std::lock_guard lock(mutex_);
  streaming_ = false;
}

void FakeLiberty::power_cycle() {
  const std::lock_guard lock(mutex_);
  settings_ = {};
  streaming_ = false;
  frame_ = 0;
  typed_.clear();
  packets_.clear();
  collected_.clear();
}

void FakeLiberty::leave_streaming(bool binary) {
  const std::lock_guard lock(mutex_);
  settings_.binary = binary;
  settings_.items = binary ? std::vector<int>{8, 9, 11, 3, 7} : std::vector<int>{2, 4, 1};
  streaming_ = true;
}

void FakeLiberty::leave_half_typed(const std::string& bytes) {
  const std::lock_guard lock(mutex_);
  typed_ = bytes;
}

void FakeLiberty::leave_units_inches() {
  const std::lock_guard lock(mutex_);
  settings_.centimetres = false;
}

void FakeLiberty::set_echo(bool on) {
  const std::lock_guard lock(mutex_);
  settings_.echo = on;
}

void FakeLiberty::set_dumb(bool dumb) {
  const std::lock_guard lock(mutex_);
  dumb_ = dumb;
}

void FakeLiberty::ignore(char command) {
  const std::lock_guard lock(mutex_);
  ignored_ += command;
}

void FakeLiberty::refuse(char command, std::uint8_t error) {
  const std::lock_guard lock(mutex_);
  refused_[static_cast<std::size_t>(command)] = error;
}

void FakeLiberty::set_tag(std::array<char, 2> tag) {
  const std::lock_guard lock(mutex_);
  tag_ = tag;
}

void FakeLiberty::set_self_test_error(bool on) {
  const std::lock_guard lock(mutex_);
  self_test_error_ = on;
}

std::vector<std::string> FakeLiberty::commands() const {
  const std::lock_guard lock(mutex_);
  return commands_;
}

bool FakeLiberty::streaming() const {
  const std::lock_guard lock(mutex_);
  return streaming_;
}

bool FakeLiberty::binary() const {
  const std::lock_guard lock(mutex_);
  return settings_.binary;
}

std::uint32_t FakeLiberty::frame_count() const {
  const std::lock_guard lock(mutex_);
  return frame_;
}

std::uint64_t FakeLiberty::cycles_sent() const {
  const std::lock_guard lock(mutex_);
  return cycles_sent_;
}

std::size_t FakeLiberty::packets_waiting() const {
  const std::lock_guard lock(mutex_);
  return packets_.size();
}

std::uint64_t FakeLiberty::bytes_dropped_by_fifo() const {
  const std::lock_guard lock(mutex_);
  return fifo_dropped_;
}

// --- commands

void FakeLiberty::execute(const std::string& command) {
  commands_.push_back(readable(command));
  if (command.empty()) return refuse_with('\r', 0x01, "Invalid Command\r\n");
  const char letter = static_cast<char>(std::toupper(static_cast<unsigned char>(command[0])));
  if (const std::uint8_t error = refused_[static_cast<std::size_t>(letter)]; error != 0 && command.size() > 1)
    return refuse_with(static_cast<std::uint8_t>(letter), error, "Refused\r\n");
  if (letter < ' ') return execute_control(command);
  if (letter == 'C') {
    streaming_ = true;
    return;
  }
  const std::size_t start = letter == '@' ? 2 : 1;
  const std::vector<double> values = numbers_after(command, start);
  const bool question = values.empty() || (values.size() == 1 && (letter == 'O' || letter == 'H'));
  if (!question && ignored_.find(letter) != std::string::npos) return;
  execute_setting(letter, values, !question);
}

void FakeLiberty::execute_setting(char letter, const std::vector<double>& values, bool has_values) {
  const auto code = static_cast<std::uint8_t>(letter);
  const int station = values.empty() ? 0 : static_cast<int>(values[0]);
  const auto reals = [&](auto& target, std::size_t from) {
    for (std::size_t i = 0; i < target.size() && from + i < values.size(); ++i)
      target[i] = static_cast<float>(values[from + i]);
  };
  const auto number = [&](int value) {
    answer(code, 0, packed(std::array{value}), fmt::format("{}", value));
  };
  switch (letter) {
    case 'F':
      if (has_values) settings_.binary = values[0] == 1;
      return;
    case 'U':
      return has_values ? void(settings_.centimetres = values[0] == 1) : number(settings_.centimetres);
    case 'R':
      return has_values ? void(settings_.rate = static_cast<int>(values[0])) : number(settings_.rate);
    case '@':
      return has_values ? void(settings_.fifo = values[0] == 1) : number(settings_.fifo);
    case 'H':
      if (has_values) return reals(settings_.hemisphere, 1);
      return answer(code, station, packed(settings_.hemisphere), "");
    case 'X':
      if (has_values) return reals(settings_.position_filter, 0);
      return answer(code, 0, packed(settings_.position_filter), "");
    case 'Y':
      if (has_values) return reals(settings_.attitude_filter, 0);
      return answer(code, 0, packed(settings_.attitude_filter), "");
    case 'O': {
      if (has_values) {
        settings_.items.assign(values.begin() + 1, values.end());
        return;
      }
      std::vector<int> list = settings_.items;
      list.push_back(-1);
      return answer(code, station, packed(list), "");
    }
    case 'Q':
      frame_ = 0;
      return;
    case 'L':
    case 'G':
    case 'N':
      return;
    default:
      return refuse_with(code, 0x01, "Invalid Command\r\n");
  }
}

void FakeLiberty::execute_control(const std::string& command) {
  const auto code = static_cast<std::uint8_t>(command[0]);
  switch (code) {
    case 0x05:
      settings_.echo = command.ends_with('1');
      return;
    case 0x12:
    case 0x02:
      return;
    case 0x14:
      if (command.size() > 1)
        self_test_error_ = false;
      else
        answer(code, 0, packed(std::array<std::uint32_t, 9>{self_test_error_ ? 4U : 0U}), "0");
      return;
    case 0x15:
      if (const std::size_t comma = command.find(','); comma != std::string::npos)
        settings_.active = static_cast<std::uint32_t>(std::stoul(command.substr(comma + 1), nullptr, 16));
      else
        answer(code, 0, packed(std::array{station_map()}), fmt::format("{:08X}", station_map()));
      return;
    case 0x16: {
      const std::string text =
          "Polhemus LIBERTY HST\r\n8 Stations\r\n\r\nSystem Controller Version:  2.0.1\r\n";
      const std::string head("\x08\x00\x00", 3);
      const Bytes body = bytes_from(head + text);
      return answer(code, 0, body, text);
    }
    default:
      return refuse_with(code, 0x01, "Invalid Command\r\n");
  }
}

std::uint32_t FakeLiberty::station_map() const {
  std::uint32_t detected = 0;
  for (std::size_t i = 0; i < sensors_.size(); ++i)
    if (sensors_[i].plugged) detected |= 1U << i;
  return settings_.active | (detected << 16);
}

void FakeLiberty::answer(std::uint8_t command, int station, const Bytes& body, const std::string& text) {
  if (dumb_) return;
  if (settings_.binary) return send(frame(station, command, 0, body));
  const std::string line =
      fmt::format("{:02}{} {}\r\n", station, static_cast<char>(std::tolower(command)), text);
  send({line.begin(), line.end()});
}

void FakeLiberty::refuse_with(std::uint8_t command, std::uint8_t error, const std::string& text) {
  if (dumb_) return;
  const Bytes body(text.begin(), text.end());
  send(settings_.binary ? frame(0, command, error, body) : body);
}

// --- output

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
  for (int station = 0; station < kMostStations; ++station) {
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
