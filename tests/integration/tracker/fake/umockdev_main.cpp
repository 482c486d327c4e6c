// main() of tests that need umockdev: runs itself again with its preload library, so that the program can be
// started by hand, by CTest and under a debugger alike.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string>

namespace {

constexpr const char* kPreload = "libumockdev-preload.so.0";

void add_to_environment(const char* name, const std::string& value, char separator) {
  const char* before = std::getenv(name);
  const std::string all =
      before != nullptr && *before != '\0' ? std::string(before) + separator + value : value;
  ::setenv(name, all.c_str(), 1);
}

}  // namespace

int main(int argc, char** argv) {
  const char* preloaded = std::getenv("LD_PRELOAD");
  if (preloaded == nullptr || std::string(preloaded).find(kPreload) == std::string::npos) {
    add_to_environment("LD_PRELOAD", kPreload, ':');
    add_to_environment("ASAN_OPTIONS", "verify_asan_link_order=0", ':');
    ::execv("/proc/self/exe", argv);
    std::perror("cannot run again under umockdev");
    return 2;
  }
  ::testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
