#include "tests/fuzz/ipc/mutated_segment.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  linescope::testing::poll_mutated_mailbox({data, size});
  return 0;
}
