#include <cstdio>
#include <cstdlib>

#include "tests/fuzz/tracker/liberty_target.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (const auto broken = linescope::testing::broken_promise({data, size})) {
    std::fprintf(stderr, "%s\n", broken->c_str());
    std::abort();
  }
  return 0;
}
