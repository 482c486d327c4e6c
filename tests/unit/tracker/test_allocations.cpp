// The way of a sample allocates nothing: counted by replacing the allocator of this program.
#include <gtest/gtest.h>

#include "acquire/tracker/liberty/liberty_stream.hpp"
#include "acquire/tracker/pose_history.hpp"
#include "acquire/tracker/sample_queue.hpp"
#include "acquire/tracker/tracker_ledger.hpp"
#include "liberty_bytes.hpp"
#include "tests/support/allocation_counter.hpp"

namespace linescope {
namespace {

using namespace testing;

class ToTheDaemon : public SampleSink {
 public:
  void on_sample(const PoseSample& sample) override { queue.push(sample); }
  void on_message(std::uint8_t, std::string_view) override {}
  SampleQueue queue{64};
};

/// A second of eight sensors, with a damaged record and a lost cycle in it.
Bytes one_second(std::uint32_t first_frame) {
  Bytes bytes;
  for (std::uint32_t i = 0; i < 240; ++i) {
    if (i == 100) continue;
    if (i == 50) append(bytes, {1, 2, 3});
    for (int station = 1; station <= 8; ++station)
      append(bytes, pose_bytes({.station = station, .frame = first_frame + i}));
  }
  return bytes;
}

TEST(Allocations, NoneBetweenTheBytesAndThePoseAtAnInstant) {
  LibertyStream stream{LibertyOptions{}};
  ToTheDaemon daemon;
  TrackerLedger ledger;
  PoseHistory history;
  std::uint64_t used = 0;
  int answered = 0;
  for (std::uint32_t second = 0; second < 3; ++second) {
    const Bytes bytes = one_second(second * 240);
    const std::size_t before = allocations_everywhere();
    Nanoseconds arrival = (second + 1) * kSecond;
    for (std::size_t at = 0; at < bytes.size(); at += 416) {
      stream.feed(std::span(bytes).subspan(at, std::min<std::size_t>(416, bytes.size() - at)),
                  arrival += 4'166'667, daemon);
      PoseSample sample;
      while (daemon.queue.pop(sample, 0)) {
        ledger.count(sample);
        history.add(sample);
        if (history.pose_at(sample.station, sample.time - 2 * kMillisecond).ok()) ++answered;
      }
    }
    if (second > 0) used += allocations_everywhere() - before;
  }
  EXPECT_EQ(used, 0u);
  EXPECT_GT(allocations_everywhere(), 0u) << "what is made at first is counted";
  EXPECT_GT(answered, 3000);
}

}  // namespace
}  // namespace linescope
