#include <gtest/gtest.h>
#include <unistd.h>

#include "acquire/scan_control.hpp"

namespace linescope {
namespace {

class ScanControlTest : public ::testing::Test {
 protected:
  ScanControlTest() : writer_(SegmentWriter::create(small_segment()).value()), scan_(writer_) {}

  static SegmentOptions small_segment() {
    SegmentOptions options;
    options.name = "linescope-unit-scan-" + std::to_string(getpid());
    options.point_capacity = 1000;
    options.line_capacity = 100;
    return options;
  }

  void sweep(int lines) {
    scan_.start(1);
    for (int i = 0; i < lines; ++i) EXPECT_EQ(offer_line(), PublishOutcome::stored);
    scan_.stop();
  }

  PublishOutcome offer_line() {
    const SurfacePoint point{{0, 0, 0}, 1, 1};
    return writer_.publish_line({}, {&point, 1});
  }

  SegmentWriter writer_;
  ScanControl scan_;
};

TEST_F(ScanControlTest, NothingIsStoredBeforeTheStart) {
  EXPECT_EQ(offer_line(), PublishOutcome::not_scanning);
}

TEST_F(ScanControlTest, UndoTakesBackOneSweepAfterTheOther) {
  sweep(3);
  sweep(4);
  sweep(0);
  EXPECT_EQ(writer_.lines_in_scan(), 7u);
  EXPECT_TRUE(scan_.undo_sweep());  // the empty sweep is passed over
  EXPECT_EQ(writer_.lines_in_scan(), 3u);
  sweep(2);
  EXPECT_TRUE(scan_.undo_sweep());
  EXPECT_EQ(writer_.lines_in_scan(), 3u);
  EXPECT_TRUE(scan_.undo_sweep());
  EXPECT_EQ(writer_.lines_in_scan(), 0u);
  EXPECT_FALSE(scan_.undo_sweep());
}

TEST_F(ScanControlTest, ClearKeepsScanningAndBeginsFromNothing) {
  scan_.start(1);
  EXPECT_EQ(offer_line(), PublishOutcome::stored);
  scan_.clear(2);
  EXPECT_TRUE(scan_.scanning());
  EXPECT_EQ(writer_.lines_in_scan(), 0u);
  EXPECT_FALSE(scan_.undo_sweep());
}

}  // namespace
}  // namespace linescope
