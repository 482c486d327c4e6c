// Latest pose and history.
#include "tests/unit/ipc/segment_fixture.hpp"

namespace linescope::testing {
namespace {

PoseSample sample(int i, std::uint8_t station = 1) {
  PoseSample s;
  s.time = 1000 * i;
  s.frame_count = static_cast<std::uint32_t>(i);
  s.station = station;
  s.state = ToolState::ok;
  s.world_from_sensor = {Eigen::Quaterniond(0.5, -0.5, 0.5, 0.5), {1.0 * i, 2.0 * i, 3.0 * i}};
  s.distortion = 0.25F;
  return s;
}

class Poses : public SegmentTest {
 protected:
  void publish_samples(int from, int to) {
    for (int i = from; i < to; ++i) writer_->publish_pose(sample(i));
  }
  std::vector<PoseSample> history_;
};

TEST_F(Poses, NothingBeforeTheFirst) {
  PoseSample pose;
  EXPECT_EQ(reader_->latest_pose(1, pose), ReadOutcome::nothing);
  EXPECT_EQ(reader_->pose_history(1, 0, 1, history_), ReadOutcome::nothing);
}

TEST_F(Poses, TheLatestComesBackWhole) {
  publish_samples(1, 8);
  PoseSample pose;
  ASSERT_EQ(reader_->latest_pose(1, pose), ReadOutcome::ok);
  EXPECT_EQ(pose.time, 7000);
  EXPECT_EQ(pose.frame_count, 7U);
  EXPECT_EQ(pose.station, 1);
  EXPECT_EQ(pose.state, ToolState::ok);
  EXPECT_EQ(pose.distortion, 0.25F);
  EXPECT_EQ(pose.world_from_sensor.translation(), Eigen::Vector3d(7, 14, 21));
  EXPECT_EQ(pose.world_from_sensor.rotation().coeffs(), sample(7).world_from_sensor.rotation().coeffs());
}

TEST_F(Poses, StationsDoNotMix) {
  writer_->publish_pose(sample(3, 0));
  writer_->publish_pose(sample(4, 7));
  PoseSample pose;
  ASSERT_EQ(reader_->latest_pose(0, pose), ReadOutcome::ok);
  EXPECT_EQ(pose.time, 3000);
  ASSERT_EQ(reader_->latest_pose(7, pose), ReadOutcome::ok);
  EXPECT_EQ(pose.time, 4000);
  EXPECT_EQ(reader_->latest_pose(1, pose), ReadOutcome::nothing);
}

TEST_F(Poses, AStationThatDoesNotExistIsCountedNotStored) {
  writer_->publish_pose(sample(1, 8));
  EXPECT_EQ(writer_->counted(Counter::tracker_samples_unknown_station), 1U);
  PoseSample pose;
  EXPECT_EQ(reader_->latest_pose(8, pose), ReadOutcome::nothing);
  EXPECT_EQ(reader_->latest_pose(-1, pose), ReadOutcome::nothing);
}

TEST_F(Poses, HistoryByTimeIsOldestFirstAndInclusive) {
  publish_samples(0, 10);
  ASSERT_EQ(reader_->pose_history(1, 3000, 6000, history_), ReadOutcome::ok);
  ASSERT_EQ(history_.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(history_[i].time, 3000 + 1000 * static_cast<Nanoseconds>(i));
}

TEST_F(Poses, HistoryFromTheVeryFirstIsComplete) {
  publish_samples(5, 10);
  ASSERT_EQ(reader_->pose_history(1, 0, 100'000, history_), ReadOutcome::ok);
  EXPECT_EQ(history_.size(), 5U);
}

TEST_F(Poses, AHistoryThatDoesNotReachBackSaysSo) {
  publish_samples(0, 100);  // the ring holds 16, of which one may be in work
  ASSERT_EQ(reader_->pose_history(1, 50'000, 100'000, history_), ReadOutcome::overtaken);
  ASSERT_EQ(history_.size(), 15U);
  EXPECT_EQ(history_.front().time, 85'000);
  EXPECT_EQ(history_.back().time, 99'000);
  history_.clear();
  EXPECT_EQ(reader_->pose_history(1, 90'000, 100'000, history_), ReadOutcome::ok);
}

TEST_F(Poses, HistoryIsAppended) {
  publish_samples(0, 3);
  reader_->pose_history(1, 0, 1000, history_);
  reader_->pose_history(1, 2000, 2000, history_);
  ASSERT_EQ(history_.size(), 3U);
  EXPECT_EQ(history_[2].time, 2000);
}

TEST_F(Poses, ACursorDeliversEachSampleOnce) {
  PoseCursor cursor;
  std::uint64_t missed = 0;
  EXPECT_EQ(reader_->new_poses(1, cursor, history_, missed), ReadOutcome::nothing);
  publish_samples(0, 5);
  ASSERT_EQ(reader_->new_poses(1, cursor, history_, missed), ReadOutcome::ok);
  EXPECT_EQ(reader_->new_poses(1, cursor, history_, missed), ReadOutcome::nothing);
  publish_samples(5, 12);
  ASSERT_EQ(reader_->new_poses(1, cursor, history_, missed), ReadOutcome::ok);
  EXPECT_EQ(missed, 0U);
  ASSERT_EQ(history_.size(), 12U);
  for (std::size_t i = 0; i < 12; ++i) EXPECT_EQ(history_[i].frame_count, i);
  EXPECT_EQ(reader_->new_poses(8, cursor, history_, missed), ReadOutcome::nothing);
}

TEST_F(Poses, AReaderSlowerThanTheRingIsToldHowManySamplesItMissed) {
  PoseCursor cursor;
  std::uint64_t missed = 0;
  publish_samples(0, 5);
  reader_->new_poses(1, cursor, history_, missed);
  history_.clear();
  publish_samples(5, 105);  // the ring holds 16, of which one may be in work
  ASSERT_EQ(reader_->new_poses(1, cursor, history_, missed), ReadOutcome::ok);
  ASSERT_EQ(history_.size(), 15U);
  EXPECT_EQ(missed, 85U);
  EXPECT_EQ(history_.front().frame_count, 90U) << "5 were read, 85 missed";
  EXPECT_EQ(history_.back().frame_count, 104U);
}

TEST_F(Poses, ALateReaderIsToldOfTheSamplesBeforeIt) {
  publish_samples(0, 40);
  SegmentReader late = attach();
  PoseCursor cursor;
  std::uint64_t missed = 0;
  ASSERT_EQ(late.new_poses(1, cursor, history_, missed), ReadOutcome::ok);
  EXPECT_EQ(missed, 25U);
  EXPECT_EQ(history_.front().frame_count, 25U);
}

TEST_F(Poses, ACursorOfAnotherSessionBeginsFromScratch) {
  PoseCursor cursor;
  std::uint64_t missed = 0;
  publish_samples(0, 9);
  reader_->new_poses(1, cursor, history_, missed);
  open(small_segment(name_));
  publish_samples(0, 3);
  history_.clear();
  ASSERT_EQ(reader_->new_poses(1, cursor, history_, missed), ReadOutcome::ok);
  EXPECT_EQ(history_.size(), 3U);
  EXPECT_EQ(missed, 0U);
}

TEST_F(Poses, TheRateIsThatOfTheSamples) {
  for (int i = 0; i < 10; ++i) {
    PoseSample s = sample(i);
    s.time = 4'000'000 * i;
    writer_->publish_pose(s);
  }
  const RateFigures rate = reader_->pose_rate(1);
  EXPECT_EQ(rate.samples, 10U);
  EXPECT_DOUBLE_EQ(rate.hz, 250);
  EXPECT_DOUBLE_EQ(rate.period_sd_ms, 0);
  EXPECT_EQ(reader_->pose_rate(0).samples, 0U);
}

}  // namespace
}  // namespace linescope::testing
