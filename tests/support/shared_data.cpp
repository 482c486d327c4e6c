#include "tests/support/shared_data.hpp"

namespace linescope::testing {

bool shared_data_present() {
  return std::filesystem::is_directory(LINESCOPE_SHARED_DATA);
}

std::filesystem::path shared_data(const std::filesystem::path& relative) {
  return std::filesystem::path(LINESCOPE_SHARED_DATA) / relative;
}

}  // namespace linescope::testing
