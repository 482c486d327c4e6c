#include "tests/integration/tracker/fake/fake_liberty.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace linescope::testing {

FakeLiberty::FakeLiberty(int sensors) : sensors_(8) {
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

}  // namespace linescope::testing
