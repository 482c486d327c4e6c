#include "tests/fuzz/ipc/mutated_segment.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  linescope::testing::read_mutated_segment({data, size});
  return 0;
}
