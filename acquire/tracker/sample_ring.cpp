#include "acquire/tracker/sample_ring.hpp"

#include <algorithm>
#include <bit>

namespace linescope {
namespace {

std::uint64_t pack(std::uint32_t high, std::uint32_t low) {
  return (static_cast<std::uint64_t>(high) << 32) | low;
}

using Words = std::array<std::uint64_t, 11>;

Words words_from(const PoseSample& s) {
  const Eigen::Vector4d q = s.world_from_sensor.rotation().coeffs();
  const Eigen::Vector3d& t = s.world_from_sensor.translation();
  const auto flags = static_cast<std::uint32_t>(s.station) | (static_cast<std::uint32_t>(s.state) << 8);
  const auto bits = [](double v) { return std::bit_cast<std::uint64_t>(v); };
  return {static_cast<std::uint64_t>(s.time),
          static_cast<std::uint64_t>(s.arrival),
          pack(s.frame_count, flags),
          bits(q[0]),
          bits(q[1]),
          bits(q[2]),
          bits(q[3]),
          bits(t[0]),
          bits(t[1]),
          bits(t[2]),
          std::bit_cast<std::uint32_t>(s.distortion)};
}

PoseSample sample_from(const Words& w) {
  const auto real = [&w](std::size_t i) { return std::bit_cast<double>(w[i]); };
  PoseSample s;
  s.time = static_cast<Nanoseconds>(w[0]);
  s.arrival = static_cast<Nanoseconds>(w[1]);
  s.frame_count = static_cast<std::uint32_t>(w[2] >> 32);
  s.station = static_cast<std::uint8_t>(w[2] & 0xff);
  s.state = static_cast<ToolState>((w[2] >> 8) & 0xff);
  s.world_from_sensor = {Eigen::Quaterniond(real(6), real(3), real(4), real(5)), {real(7), real(8), real(9)}};
  s.distortion = std::bit_cast<float>(static_cast<std::uint32_t>(w[10]));
  return s;
}

}  // namespace

SampleRing::SampleRing(int capacity) : slots_(static_cast<std::size_t>(std::max(capacity, 2))) {
  static_assert(std::tuple_size_v<Words> == kWords);
}

// Words are stored with release and loaded with acquire order: a reader that sees one word of a newer sample
// therefore also sees the announcement that was made before it, and still_there() says no.
void SampleRing::push(const PoseSample& sample) {
  const std::uint64_t index = written_.load(std::memory_order_relaxed);
  announced_.store(index + 1, std::memory_order_relaxed);
  Slot& slot = slots_[index % slots_.size()];
  const Words words = words_from(sample);
  for (std::size_t i = 0; i < kWords; ++i) slot[i].store(words[i], std::memory_order_release);
  written_.store(index + 1, std::memory_order_release);
}

std::uint64_t SampleRing::begin(std::uint64_t end) const {
  return end > slots_.size() ? end - slots_.size() : 0;
}

bool SampleRing::still_there(std::uint64_t index) const {
  return announced_.load(std::memory_order_relaxed) <= index + slots_.size();
}

bool SampleRing::read(std::uint64_t index, PoseSample& out) const {
  const Slot& slot = slots_[index % slots_.size()];
  Words words;
  for (std::size_t i = 0; i < kWords; ++i) words[i] = slot[i].load(std::memory_order_acquire);
  if (!still_there(index)) return false;
  out = sample_from(words);
  return true;
}

bool SampleRing::read_time(std::uint64_t index, Nanoseconds& out) const {
  out = static_cast<Nanoseconds>(slots_[index % slots_.size()][0].load(std::memory_order_acquire));
  return still_there(index);
}

}  // namespace linescope
