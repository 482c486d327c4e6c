#include <gtest/gtest.h>

#include <thread>

#include "acquire/record/handover_ring.hpp"

namespace linescope {
namespace {

TEST(HandoverRing, FullIsToldAndOldestComesFirst) {
  HandoverRing<int> ring(3);
  EXPECT_EQ(ring.front(), nullptr);
  for (int i = 0; i < 3; ++i) {
    *ring.claim() = i;
    ring.publish();
  }
  EXPECT_EQ(ring.claim(), nullptr);
  EXPECT_EQ(ring.size(), 3U);
  for (int i = 0; i < 3; ++i) {
    ASSERT_NE(ring.front(), nullptr);
    EXPECT_EQ(*ring.front(), i);
    ring.pop();
  }
  EXPECT_EQ(ring.front(), nullptr);
}

TEST(HandoverRing, TwoThreadsLoseAndRepeatNothing) {
  // Few enough that a busy machine, where every yield may cost a time slice, gets through; the ring wraps 150
  // times.
  constexpr int kItems = 10'000;
  HandoverRing<int> ring(64);
  std::thread producer([&ring] {
    for (int i = 0; i < kItems;) {
      if (int* slot = ring.claim()) {
        *slot = i++;
        ring.publish();
      } else {
        std::this_thread::yield();
      }
    }
  });
  int expected = 0;
  while (expected < kItems) {
    if (const int* item = ring.front()) {
      ASSERT_EQ(*item, expected++);
      ring.pop();
    } else {
      std::this_thread::yield();
    }
  }
  producer.join();
}

}  // namespace
}  // namespace linescope
