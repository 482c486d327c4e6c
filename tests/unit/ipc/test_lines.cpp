// Lines and points: what goes in comes out, and a reader is told exactly what it missed.
#include "tests/unit/ipc/segment_fixture.hpp"

namespace linescope::testing {
namespace {

class Lines : public SegmentTest {
 protected:
  void SetUp() override {
    SegmentTest::SetUp();
    writer_->set_scanning(true);
  }
  LineCursor cursor_;
  LineBatch batch_;
};

TEST_F(Lines, EverythingOfALineComesBack) {
  ASSERT_EQ(publish(3, 100), PublishOutcome::stored);
  ASSERT_EQ(reader_->read_lines(cursor_, batch_), ReadOutcome::ok);
  ASSERT_EQ(batch_.lines.size(), 1U);
  const Line& line = batch_.lines[0];
  const ScanLineInfo wanted = info_for(3);
  EXPECT_EQ(line.time, wanted.time);
  EXPECT_EQ(line.frame, wanted.frame);
  EXPECT_EQ(line.endoscope.world_from_tool.translation(), wanted.endoscope.world_from_tool.translation());
  EXPECT_EQ(line.endoscope.world_from_tool.rotation().coeffs(),
            wanted.endoscope.world_from_tool.rotation().coeffs());
  EXPECT_EQ(line.object.world_from_tool.translation(), wanted.object.world_from_tool.translation());
  EXPECT_EQ(line.object.state, ToolState::distorted_field);
  EXPECT_EQ(line.harvester.world_from_tool.rotation().coeffs(),
            wanted.harvester.world_from_tool.rotation().coeffs());
  EXPECT_EQ(line.harvester.state, ToolState::missing);
  EXPECT_EQ(line.quality.mean_peak, 101);
  EXPECT_EQ(line.quality.mean_width, 2.5F);
  EXPECT_EQ(line.quality.mean_snr, 12);
  EXPECT_EQ(line.quality.mean_deviation, 0.25F);
  EXPECT_EQ(line.quality.coverage, 0.75F);
  EXPECT_EQ(line.quality.rejected, 17U);
  EXPECT_EQ(line.quality.pose_gap, 4'000'000);
  EXPECT_EQ(line.scan_id, 1U);
  EXPECT_EQ(line.index, 0U);
  EXPECT_EQ(line.serial, 0U);
  expect_points(batch_.points_of(line), 3, 100);
}

TEST_F(Lines, OddAndEvenCountsLieSideBySide) {
  for (int seed = 1; seed <= 9; ++seed)
    ASSERT_EQ(publish(seed, static_cast<std::size_t>(seed)), PublishOutcome::stored);
  ASSERT_EQ(reader_->read_lines(cursor_, batch_), ReadOutcome::ok);
  ASSERT_EQ(batch_.lines.size(), 9U);
  EXPECT_EQ(batch_.points.size(), 45U);
  for (const Line& line : batch_.lines)
    expect_points(batch_.points_of(line), static_cast<int>(line.frame), line.frame);
}

TEST_F(Lines, ACursorDeliversEachLineOnce) {
  publish(1, 10);
  ASSERT_EQ(reader_->read_lines(cursor_, batch_), ReadOutcome::ok);
  EXPECT_EQ(reader_->read_lines(cursor_, batch_), ReadOutcome::nothing);
  publish(2, 10);
  publish(3, 10);
  ASSERT_EQ(reader_->read_lines(cursor_, batch_), ReadOutcome::ok);
  ASSERT_EQ(batch_.lines.size(), 2U);
  EXPECT_EQ(batch_.lines[0].frame, 2U);
  EXPECT_EQ(batch_.lines[1].frame, 3U);
  EXPECT_EQ(batch_.missed, 0U);
}

TEST_F(Lines, ABatchIsBoundedAndSaysThatThereIsMore) {
  for (int seed = 0; seed < 10; ++seed) publish(seed, 100);
  ASSERT_EQ(reader_->read_lines(cursor_, batch_, 350), ReadOutcome::ok);
  EXPECT_EQ(batch_.lines.size(), 3U);
  EXPECT_TRUE(batch_.more);
  ASSERT_EQ(reader_->read_lines(cursor_, batch_, 10'000), ReadOutcome::ok);
  EXPECT_EQ(batch_.lines.size(), 7U);
  EXPECT_FALSE(batch_.more);
}

TEST_F(Lines, ALineLongerThanTheBatchIsDeliveredAllTheSame) {
  publish(1, 100);
  ASSERT_EQ(reader_->read_lines(cursor_, batch_, 1), ReadOutcome::ok);
  EXPECT_EQ(batch_.points.size(), 100U);
}

TEST_F(Lines, ALateReaderGetsTheWholeScan) {
  for (int seed = 0; seed < 20; ++seed) publish(seed, 90);
  SegmentReader late = attach();
  ASSERT_EQ(late.read_lines(cursor_, batch_), ReadOutcome::ok);
  ASSERT_EQ(batch_.lines.size(), 20U);
  EXPECT_EQ(batch_.missed, 0U);
  for (const Line& line : batch_.lines)
    expect_points(batch_.points_of(line), static_cast<int>(line.frame), 90);
}

TEST_F(Lines, ALateReaderIsToldOfTheScansBefore) {
  for (int seed = 0; seed < 7; ++seed) publish(seed, 10);
  writer_->begin_scan(monotonic_now());
  publish(7, 10);
  SegmentReader late = attach();
  ASSERT_EQ(late.read_lines(cursor_, batch_), ReadOutcome::ok);
  EXPECT_EQ(batch_.missed, 7U);
  EXPECT_FALSE(batch_.restarted);
  EXPECT_EQ(batch_.scan_id, 2U);
  EXPECT_EQ(batch_.lines.size(), 1U);
}

TEST_F(Lines, WhoSleepsPastAWholeScanIsToldHowManyLinesThatCost) {
  publish(0, 10);
  ASSERT_EQ(reader_->read_lines(cursor_, batch_), ReadOutcome::ok);
  for (int seed = 1; seed < 5; ++seed) publish(seed, 10);  // 4 lines of the first scan
  writer_->begin_scan(monotonic_now());
  for (int seed = 5; seed < 11; ++seed) publish(seed, 10);  // 6 of the second
  writer_->begin_scan(monotonic_now());
  publish(11, 10);
  ASSERT_EQ(reader_->read_lines(cursor_, batch_), ReadOutcome::ok);
  EXPECT_TRUE(batch_.restarted);
  EXPECT_EQ(batch_.missed, 10U);
  EXPECT_EQ(batch_.scan_id, 3U);
  ASSERT_EQ(batch_.lines.size(), 1U);
  EXPECT_EQ(batch_.lines[0].frame, 11U);
}

TEST_F(Lines, AClearedScanIsToldEvenWhenNothingFollows) {
  publish(0, 10);
  reader_->read_lines(cursor_, batch_);
  writer_->begin_scan(monotonic_now(), ScanCause::cleared);
  ASSERT_EQ(reader_->read_lines(cursor_, batch_), ReadOutcome::ok);
  EXPECT_TRUE(batch_.restarted);
  EXPECT_TRUE(batch_.lines.empty());
  EXPECT_EQ(batch_.missed, 0U);
  EXPECT_EQ(reader_->read_lines(cursor_, batch_), ReadOutcome::nothing);
}

TEST_F(Lines, AfterAnUndoTheKeptLinesComeAgainAndTheNextFollow) {
  for (int seed = 0; seed < 8; ++seed) publish(seed, 11);
  reader_->read_lines(cursor_, batch_);
  writer_->undo_to(5);
  publish(100, 11);
  ASSERT_EQ(reader_->read_lines(cursor_, batch_), ReadOutcome::ok);
  EXPECT_TRUE(batch_.restarted);
  EXPECT_EQ(batch_.scan_id, 1U);
  EXPECT_EQ(batch_.missed, 0U) << "the undone lines had been read, the kept ones come again";
  ASSERT_EQ(batch_.lines.size(), 6U);
  for (int i = 0; i < 5; ++i)
    expect_points(batch_.points_of(batch_.lines[static_cast<std::size_t>(i)]), i, 11);
  expect_points(batch_.points_of(batch_.lines[5]), 100, 11);
  EXPECT_EQ(batch_.lines[5].serial, 8U);
  EXPECT_EQ(writer_->counted(Counter::lines_undone), 3U);
}

TEST_F(Lines, UndoneLinesNobodyReadCountAsMissed) {
  for (int seed = 0; seed < 3; ++seed) publish(seed, 11);
  reader_->read_lines(cursor_, batch_);
  for (int seed = 3; seed < 8; ++seed) publish(seed, 11);
  writer_->undo_to(5);
  ASSERT_EQ(reader_->read_lines(cursor_, batch_), ReadOutcome::ok);
  EXPECT_EQ(batch_.lines.size(), 5U);
  EXPECT_EQ(batch_.missed, 3U);
}

TEST_F(Lines, AnUndoToMoreThanThereIsChangesNothing) {
  publish(0, 10);
  reader_->read_lines(cursor_, batch_);
  writer_->undo_to(1);
  EXPECT_EQ(reader_->read_lines(cursor_, batch_), ReadOutcome::nothing);
}

TEST_F(Lines, NotScanningStoresNothingAndCountsIt) {
  writer_->set_scanning(false);
  EXPECT_FALSE(reader_->scanning());
  EXPECT_EQ(publish(0, 10), PublishOutcome::not_scanning);
  EXPECT_EQ(reader_->read_lines(cursor_, batch_), ReadOutcome::nothing);
  EXPECT_EQ(writer_->counted(Counter::lines_not_scanning), 1U);
  EXPECT_EQ(writer_->counted(Counter::lines_offered), 1U);
  EXPECT_EQ(writer_->counted(Counter::lines_published), 0U);
}

TEST_F(Lines, AnEmptyAndATooLongLineAreInvalid) {
  EXPECT_EQ(publish(0, 0), PublishOutcome::invalid);
  EXPECT_EQ(publish(0, 201), PublishOutcome::invalid);
  EXPECT_EQ(publish(0, 200), PublishOutcome::stored);
  EXPECT_EQ(writer_->counted(Counter::lines_invalid), 2U);
}

TEST_F(Lines, FullOfLinesIsAStateThatCountsWhatItCouldNotStore) {
  for (int seed = 0; seed < 50; ++seed) ASSERT_EQ(publish(seed, 2), PublishOutcome::stored);
  EXPECT_FALSE(reader_->full());
  EXPECT_EQ(publish(50, 2), PublishOutcome::full);
  EXPECT_EQ(publish(51, 2), PublishOutcome::full);
  EXPECT_TRUE(reader_->full());
  EXPECT_EQ(writer_->counted(Counter::lines_segment_full), 2U);
  EXPECT_EQ(writer_->counted(Counter::points_segment_full), 4U);
  reader_->read_lines(cursor_, batch_);
  EXPECT_EQ(batch_.lines.size(), 50U);
}

TEST_F(Lines, FullOfPointsKeepsPosesAndPicturesFlowing) {
  for (int seed = 0; seed < 10; ++seed) ASSERT_EQ(publish(seed, 199), PublishOutcome::stored);
  EXPECT_EQ(publish(10, 1), PublishOutcome::full) << "an odd line takes an even room: 10 times 200 are all";
  PoseSample pose;
  pose.station = 2;
  writer_->publish_pose(pose);
  EXPECT_EQ(reader_->latest_pose(2, pose), ReadOutcome::ok);
  writer_->begin_scan(monotonic_now());
  EXPECT_FALSE(reader_->full()) << "a new scan has room again";
  EXPECT_EQ(publish(11, 1), PublishOutcome::stored);
}

TEST_F(Lines, EveryOfferedLineIsAccountedFor) {
  for (int seed = 0; seed < 60; ++seed) publish(seed, seed % 7 == 0 ? 0 : 30);
  writer_->set_scanning(false);
  publish(60, 30);
  EXPECT_EQ(writer_->counted(Counter::lines_offered),
            writer_->counted(Counter::lines_published) + writer_->counted(Counter::lines_segment_full) +
                writer_->counted(Counter::lines_not_scanning) + writer_->counted(Counter::lines_invalid));
}

TEST_F(Lines, ACursorOfAnotherSessionBeginsFromScratch) {
  publish(0, 10);
  reader_->read_lines(cursor_, batch_);
  open(small_segment(name_));
  writer_->set_scanning(true);
  publish(42, 10);
  ASSERT_EQ(reader_->read_lines(cursor_, batch_), ReadOutcome::ok);
  ASSERT_EQ(batch_.lines.size(), 1U);
  EXPECT_EQ(batch_.lines[0].frame, 42U);
}

}  // namespace
}  // namespace linescope::testing
