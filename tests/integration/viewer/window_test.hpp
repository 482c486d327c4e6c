// What the tests of the window share: tools that move, what the window shows, a display.
#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "common/units.hpp"
#include "tests/integration/viewer/viewer_under_test.hpp"
#include "tests/unit/viewer/fake_daemon.hpp"

namespace linescope::testing {

using namespace std::chrono_literals;

/// Publishes the three tools at about 100 Hz until told otherwise.
class MovingTools {
 public:
  explicit MovingTools(FakeDaemon& daemon, double tilt_deg)
      : thread_([this, &daemon, tilt = radians_from_degrees(tilt_deg)] {
          while (!stop_) {
            if (!frozen_) daemon.publish_tools(tilt, object_.load(), harvester_.load());
            std::this_thread::sleep_for(10ms);
          }
        }) {}
  ~MovingTools() {
    stop_ = true;
    thread_.join();
  }
  void freeze() { frozen_ = true; }
  void thaw() { frozen_ = false; }
  void set_object(ToolState state) { object_ = state; }
  void set_harvester(ToolState state) { harvester_ = state; }

 private:
  std::atomic<bool> stop_{false}, frozen_{false};
  std::atomic<ToolState> object_{ToolState::ok}, harvester_{ToolState::ok};
  std::thread thread_;
};

inline bool has_angle(const QJsonObject& shown) {
  return !shown.isEmpty() && shown["angle_text"].toString() != "--";
}
inline double angle_of(const QJsonObject& shown) {
  const QString text = shown["angle_text"].toString();
  return text.leftRef(text.size() - 1).toDouble();
}

class WindowTest : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(display_.up()) << "Xvfb is needed: apt-get install xvfb"; }
  void TearDown() override { remove_leftovers(segment_); }

  const std::string segment_ = unique_segment();
  VirtualDisplay display_;
};

}  // namespace linescope::testing
