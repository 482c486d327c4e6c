#include "tests/bench/laser/read_pass.hpp"

#include <array>
#include <cstdint>

namespace linescope::bench {

__attribute__((target_clones("avx2", "default"), optimize("O3"))) unsigned long long read_pass(
    const void* bytes, unsigned long size) {
  constexpr std::size_t kLanes = 16;
  std::array<std::uint64_t, kLanes> lanes{};
  const auto* p = static_cast<const std::uint64_t*>(bytes);
  const std::size_t words = size / sizeof(std::uint64_t);
  for (std::size_t i = 0; i + kLanes <= words; i += kLanes)
    for (std::size_t k = 0; k < kLanes; ++k) lanes[k] ^= p[i + k];
  std::uint64_t all = 0;
  for (const std::uint64_t l : lanes) all ^= l;
  return all;
}

}  // namespace linescope::bench
