// Where the real recordings lie. They are not part of the repository: tests read them in place.
#pragma once

#include <filesystem>

namespace linescope::testing {

/// True when the folder exists. When it does not: in CI (environment CI set) the calling test fails,
/// elsewhere it is reported as skipped with the reason. Use through LINESCOPE_NEEDS_SHARED_DATA.
bool shared_data_present();

/// The folder or file of that relative name, for example shared_data("miniature-scanner/poses.csv").
std::filesystem::path shared_data(const std::filesystem::path& relative);

}  // namespace linescope::testing

#define LINESCOPE_NEEDS_SHARED_DATA()                                                                       \
  do {                                                                                                      \
    if (!::linescope::testing::shared_data_present()) {                                                     \
      if (std::getenv("CI") != nullptr) GTEST_FAIL() << "the real recordings are missing";                  \
      GTEST_SKIP() << "the real recordings are not on this machine (cmake -DLINESCOPE_SHARED_DATA=FOLDER)"; \
    }                                                                                                       \
  } while (false)
