#include "tests/support/finished_run.hpp"

#include <fstream>
#include <iterator>

#include "tests/support/child_process.hpp"

namespace linescope::testing {

Finished run_to_end(std::vector<std::string> arguments, std::chrono::milliseconds patience) {
  ChildProcess child(std::move(arguments));
  const auto end = child.wait(patience);
  return {end && !end->signalled ? end->code : -1, child.standard_output(), child.standard_error()};
}

std::string file_contents(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace linescope::testing
