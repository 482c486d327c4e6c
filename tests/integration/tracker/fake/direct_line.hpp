// The shortest line to a fake LIBERTY: no operating system in between.
#pragma once

#include <atomic>
#include <memory>
#include <thread>

#include "acquire/tracker/liberty/byte_transport.hpp"
#include "tests/integration/tracker/fake/fake_liberty.hpp"

namespace linescope::testing {

/// Shared by test and transport: the unit, and whether its plug is in.
struct DirectLine {
  explicit DirectLine(int sensors) : unit(sensors) {}
  FakeLiberty unit;
  std::atomic<bool> plugged{true};
  std::atomic<int> opened{0};
  /// The next read finds nothing and ends only after this: the reading process itself was stopped.
  std::atomic<Nanoseconds> stopped_for{0};
};

class DirectTransport : public ByteTransport {
 public:
  explicit DirectTransport(std::shared_ptr<DirectLine> line) : line_(std::move(line)) {}

  Result<void> open() override {
    if (!line_->plugged) return fail(ErrorCode::not_found, "the direct line is unplugged");
    ++line_->opened;
    return {};
  }
  void close() override {}
  Result<void> write(std::string_view bytes) override {
    if (!line_->plugged) return gone();
    line_->unit.receive({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
    return {};
  }
  Result<Chunk> read(Nanoseconds) override {
    if (!line_->plugged) return gone();
    if (const Nanoseconds stopped = line_->stopped_for.exchange(0); stopped > 0) {
      std::this_thread::sleep_for(std::chrono::nanoseconds(stopped));
      return Chunk{};
    }
    const auto packet = line_->unit.next_packet();
    if (!packet) {
      std::this_thread::sleep_for(std::chrono::microseconds(200));
      return Chunk{};
    }
    packet_ = *packet;
    return Chunk{packet_, monotonic_now()};
  }
  void wait_for_change(Nanoseconds) override { std::this_thread::sleep_for(std::chrono::milliseconds(1)); }
  std::string description() const override { return "the direct line"; }
  std::string silence_hint() const override { return "look at the test"; }
  std::uint64_t faults() const override { return 0; }

 private:
  static tl::unexpected<Error> gone() { return fail(ErrorCode::gone, "the direct line was unplugged"); }

  std::shared_ptr<DirectLine> line_;
  std::vector<std::uint8_t> packet_;
};

}  // namespace linescope::testing
