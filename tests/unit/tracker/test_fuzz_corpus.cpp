// The fuzzer's corpus, and a short run of random changes to it, in every check.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <vector>

#include "tests/fuzz/tracker/liberty_target.hpp"

namespace linescope::testing {
namespace {

using Bytes = std::vector<std::uint8_t>;

std::vector<Bytes> corpus() {
  std::vector<Bytes> files;
  for (const auto& entry : std::filesystem::directory_iterator(LINESCOPE_FUZZ_CORPUS)) {
    std::ifstream in(entry.path(), std::ios::binary);
    files.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  }
  return files;
}

TEST(LibertyFuzzCorpus, EveryPromiseHoldsOnTheCorpus) {
  const auto files = corpus();
  ASSERT_GE(files.size(), 6u);
  for (const Bytes& file : files) {
    const auto broken = broken_promise(file);
    EXPECT_FALSE(broken) << *broken;
  }
}

TEST(LibertyFuzzCorpus, EveryPromiseHoldsOnRandomChanges) {
  const auto files = corpus();
  std::mt19937 random(4711);
  const auto below = [&random](std::size_t n) {
    return std::uniform_int_distribution<std::size_t>(0, n - 1)(random);
  };
  for (int run = 0; run < 20'000; ++run) {
    Bytes input = files[below(files.size())];
    for (std::size_t change = 0, n = 1 + below(6); change < n && input.size() > 2; ++change) {
      const std::size_t at = below(input.size());
      const auto here = input.begin() + static_cast<std::ptrdiff_t>(at);
      switch (below(4)) {
        case 0:
          *here = static_cast<std::uint8_t>(below(256));
          break;
        case 1:
          input.erase(here, here + static_cast<std::ptrdiff_t>(
                                       1 + below(std::min<std::size_t>(60, input.size() - at))));
          break;
        case 2:
          input.insert(here, static_cast<std::uint8_t>(below(256)));
          break;
        default: {
          const Bytes copy(here, here + static_cast<std::ptrdiff_t>(
                                            std::min<std::size_t>(1 + below(60), input.size() - at)));
          const auto to = static_cast<std::ptrdiff_t>(below(input.size()));
          input.insert(input.begin() + to, copy.begin(), copy.end());
        }
      }
    }
    const auto broken = broken_promise(input);
    ASSERT_FALSE(broken) << *broken << " in run " << run;
  }
}

}  // namespace
}  // namespace linescope::testing
