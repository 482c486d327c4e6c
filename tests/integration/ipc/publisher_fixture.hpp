// Tests with a living test publisher, and programs run against it.
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <thread>

#include "ipc/segment_reader.hpp"
#include "tests/integration/ipc/child.hpp"
#include "tests/support/child_process.hpp"

namespace linescope::testing {

struct Finished {
  int exit_code = -1;  ///< -1: ended by a signal
  std::string output;  ///< standard output and errors
};

class PublisherTest : public ::testing::Test {
 protected:
  void start_publisher(const std::string& lines_per_second) {
    publisher_.reset();       // the one before it ends first: two would write into one segment
    remove_leftovers(name_);  // it was killed: what it left would be taken for the next one's
    publisher_ =
        std::make_unique<Child>(Child::program({LINESCOPE_IPC_PUBLISHER, name_, lines_per_second}, log_));
    // Seen once is enough: at full speed the next look may well find a picture that is just overwritten.
    bool published = publishes();
    for (int i = 0; i < 2'000 && !published; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      published = publishes();
    }
    ASSERT_TRUE(published);
  }

  /// Lines, a picture and all poses are there.
  bool publishes() const {
    auto reader = SegmentReader::attach({.name = name_});
    Picture picture;
    PoseSample pose;
    return reader && reader->picture(picture) == ReadOutcome::ok &&
           reader->latest_pose(7, pose) == ReadOutcome::ok;
  }

  Finished run(const std::vector<std::string>& arguments) const {
    const std::string output = log_ + ".run";
    const int status = Child::program(arguments, output).wait();
    std::ifstream in(output);
    Finished finished{WIFEXITED(status) ? WEXITSTATUS(status) : -1, {std::istreambuf_iterator<char>(in), {}}};
    ::unlink(output.c_str());
    return finished;
  }

  /// linescope-inspect once; again when it says that the publisher is silent, which on a busy machine is the
  /// truth for a moment.
  Finished inspect(std::vector<std::string> options = {}) const {
    options.insert(options.begin(), {LINESCOPE_INSPECT, name_});
    constexpr int kSilent = 4;
    Finished finished = run(options);
    for (int i = 0; i < 10 && finished.exit_code == kSilent; ++i) finished = run(options);
    return finished;
  }

  void TearDown() override {
    publisher_.reset();
    remove_leftovers(name_);
    ::unlink(log_.c_str());
  }

  const std::string name_ = "linescope-live-" + std::to_string(::getpid());
  const std::string log_ = ::testing::TempDir() + name_ + ".log";
  std::unique_ptr<Child> publisher_;
};

}  // namespace linescope::testing
