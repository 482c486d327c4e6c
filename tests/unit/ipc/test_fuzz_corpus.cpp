// The fuzz targets in the normal build: the stored inputs, and mutations from a fixed seed aimed at the words
// that matter.
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <vector>

#include "ipc/segment_layout.h"
#include "tests/fuzz/ipc/mutated_segment.hpp"

namespace linescope::testing {
namespace {

using Input = std::vector<std::uint8_t>;

template <class Use>
int each_stored(const std::string& corpus, const Use& use) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(LINESCOPE_SOURCE_DIR) /
                                                               "tests/fuzz/ipc" / corpus)) {
    std::ifstream in(entry.path(), std::ios::binary);
    use(Input(std::istreambuf_iterator<char>(in), {}));
    ++count;
  }
  return count;
}

/// Values on both sides of every limit a check may have.
std::uint64_t telling_value(std::mt19937& random) {
  const std::uint64_t values[] = {0,
                                  1,
                                  2,
                                  7,
                                  8,
                                  63,
                                  64,
                                  65,
                                  255,
                                  4095,
                                  4096,
                                  UINT32_MAX,
                                  UINT32_MAX + 1ULL,
                                  UINT64_MAX,
                                  UINT64_MAX / 2,
                                  UINT64_MAX - 63};
  const std::uint64_t value = values[random() % std::size(values)];
  return random() % 3 == 0 ? value + (std::uint64_t{random()} << (random() % 40)) : value;
}

Input mutation(std::mt19937& random, std::uint32_t span) {
  Input input;
  for (std::uint32_t patches = 1 + random() % 4; patches > 0; --patches) {
    const bool resize = random() % 50 == 0;
    const std::uint32_t offset = resize ? 0xfffffff0U + random() % 16 : random() % span / 4 * 4;
    const std::uint64_t value = telling_value(random);
    const std::uint8_t length = random() % 2 == 0 ? 4 : 8;
    input.insert(input.end(), reinterpret_cast<const std::uint8_t*>(&offset),
                 reinterpret_cast<const std::uint8_t*>(&offset) + 4);
    input.push_back(length);
    input.insert(input.end(), reinterpret_cast<const std::uint8_t*>(&value),
                 reinterpret_cast<const std::uint8_t*>(&value) + length);
  }
  return input;
}

TEST(FuzzReplay, StoredSegmentsHarmNoReader) {
  EXPECT_GT(each_stored("corpus-segment", [](const Input& input) { read_mutated_segment(input); }), 0);
}

TEST(FuzzReplay, StoredMailboxesHarmNoDaemon) {
  EXPECT_GT(each_stored("corpus-mailbox", [](const Input& input) { poll_mutated_mailbox(input); }), 0);
}

TEST(FuzzReplay, MutatedHeadersHarmNoReader) {
  std::mt19937 random(1);
  for (int i = 0; i < 5'000; ++i) read_mutated_segment(mutation(random, LS_HEADER_BYTES));
}

TEST(FuzzReplay, MutatedContentsHarmNoReader) {
  std::mt19937 random(2);
  for (int i = 0; i < 5'000; ++i) read_mutated_segment(mutation(random, 100'000));
}

TEST(FuzzReplay, MutatedMailboxesHarmNoDaemon) {
  std::mt19937 random(3);
  for (int i = 0; i < 5'000; ++i) poll_mutated_mailbox(mutation(random, 20'000));
}

}  // namespace
}  // namespace linescope::testing
