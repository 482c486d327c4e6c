// Copying, checksum, histogram: the small parts.
#include <gtest/gtest.h>

#include <array>
#include <numeric>

#include "ipc/segment_statistics.hpp"
#include "ipc/shared_ring.hpp"
#include "ipc/shared_words.hpp"

namespace linescope::testing {
namespace {

std::uint64_t checksum_of(std::initializer_list<std::uint64_t> words) {
  shared::Checksum sum;
  for (const std::uint64_t word : words) sum.add(word);
  return sum.value();
}

TEST(SharedWords, CopiesWhatWasThereAndNoMore) {
  std::array<std::uint64_t, 8> shared{}, out{};
  std::array<char, 64> unaligned{};
  std::iota(unaligned.begin(), unaligned.end(), 'A');
  shared::copy_in(shared.data(), unaligned.data() + 1, 4);
  EXPECT_EQ(std::memcmp(shared.data(), unaligned.data() + 1, 32), 0);
  EXPECT_EQ(shared[4], 0U);
  shared::copy_out(out.data(), shared.data(), 3);
  EXPECT_EQ(std::memcmp(out.data(), unaligned.data() + 1, 24), 0);
  EXPECT_EQ(out[3], 0U);
}

TEST(SharedWords, BothDirectionsAgreeAboutTheChecksum) {
  std::array<std::uint64_t, 100> in{}, shared{}, out{};
  std::iota(in.begin(), in.end(), 0x9e3779b97f4a7c15U);
  shared::Checksum in_sum, out_sum;
  shared::copy_in(shared.data(), in.data(), in.size(), in_sum);
  shared::copy_out(out.data(), shared.data(), out.size(), out_sum);
  EXPECT_EQ(in_sum.value(), out_sum.value());
  EXPECT_EQ(in, out);
}

TEST(SharedWords, TheChecksumSeesWhatTearingDoes) {
  const std::uint64_t good = checksum_of({1, 2, 3, 4});
  EXPECT_NE(good, checksum_of({1, 2, 3, 5})) << "a changed word";
  EXPECT_NE(good, checksum_of({1, 3, 2, 4})) << "swapped words";
  EXPECT_NE(good, checksum_of({1, 2, 3})) << "a missing word";
  EXPECT_NE(good, checksum_of({0, 1, 2, 3, 4})) << "a zero in front";
  EXPECT_NE(checksum_of({}), 0U) << "a record of zeros is not a good one";
}

/// As documented for readers in other languages.
TEST(SharedWords, TheChecksumIsTheDocumentedFormula) {
  const std::uint64_t start = 0x9e3779b97f4a7c15U;
  const std::uint64_t a = start + 7 + 11 + 13, b = 3 * start + 3 * 7 + 2 * 11 + 13;
  EXPECT_EQ(checksum_of({7, 11, 13}), (a ^ ((b << 32) | (b >> 32))) | 1U);
}

TEST(LatencyHistogram, EveryValueLiesInItsBucketAndBucketsDoNotOverlap) {
  for (std::size_t bucket = 1; bucket < LS_LATENCY_BUCKETS - 1; ++bucket) {
    const std::uint64_t end = latency_bucket_end(bucket);
    EXPECT_EQ(latency_bucket(end), bucket);
    EXPECT_EQ(latency_bucket(end + 1), bucket + 1);
    EXPECT_LE(static_cast<double>(end), 1.25 * static_cast<double>(latency_bucket_end(bucket - 1) + 1));
  }
  EXPECT_EQ(latency_bucket(0), 0U);
  EXPECT_EQ(latency_bucket(UINT64_MAX), static_cast<std::size_t>(LS_LATENCY_BUCKETS - 1));
}

TEST(LatencyHistogram, AnEmptyOneHasNoFigures) {
  ls_latency h{};
  std::memset(h.name, 'x', sizeof h.name);  // not terminated: as a damaged segment might be
  const LatencyFigures f = latency_figures(h);
  EXPECT_EQ(f.count, 0U);
  EXPECT_EQ(f.name.size(), sizeof h.name);
}

TEST(Rates, MeanAndSpreadOfThePeriod) {
  const std::array<Nanoseconds, 4> times{0, 10 * kMillisecond, 30 * kMillisecond, 60 * kMillisecond};
  const RateFigures f = rate_figures(times);
  EXPECT_DOUBLE_EQ(f.period_mean_ms, 20);
  EXPECT_DOUBLE_EQ(f.hz, 50);
  EXPECT_DOUBLE_EQ(f.period_sd_ms, 10);
  EXPECT_DOUBLE_EQ(f.period_max_ms, 30);
  EXPECT_EQ(rate_figures({}).hz, 0);
}

/// A writer that was killed in the middle of a record: head names the last whole one, and no reader hangs.
TEST(Ring, AHalfWrittenRecordIsNeverSeen) {
  alignas(64) std::array<std::byte, 64 + 4 * sizeof(ls_frame_record)> memory{};
  const ls_section section{
      LS_SECTION_FRAMES, sizeof(ls_frame_record), 0, memory.size(), 4, 1, memory.size(), 0};
  shared::RingWriter writer(memory.data(), section);
  for (int i = 0; i < 9; ++i) {
    ls_frame_record record{};
    record.time_ns = i;
    writer.publish(record);
  }
  ls_frame_record half{};
  half.time_ns = -1;
  shared::put(shared::RingIn::as<ls_frame_record>(writer.place()), half);  // killed before publish()
  const shared::RingOut ring(memory.data(), section, 0);
  EXPECT_EQ(shared::load(ring.head()), 9U);
  EXPECT_TRUE(ring.intact(8));
  EXPECT_TRUE(ring.intact(6));
  EXPECT_FALSE(ring.intact(5)) << "its slot may be the one in work";
  EXPECT_EQ(shared::RingOut::as<ls_frame_record>(ring.place(8)).time_ns, 8);
}

}  // namespace
}  // namespace linescope::testing
