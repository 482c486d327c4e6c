// From the capture to the folder and back; full, slow and failing disks; a killed process.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <condition_variable>
#include <csignal>
#include <fstream>

#include "acquire/record/recorded_camera.hpp"
#include "acquire/record/recorded_tracker.hpp"
#include "acquire/record/recorder.hpp"
#include "acquire/record/recording.hpp"
#include "tests/support/child_process.hpp"
#include "tests/unit/record/sample_data.hpp"

namespace linescope {
namespace {

using ::testing::HasSubstr;
using testing::made_frame;
using testing::made_info;
using testing::made_sample;
using testing::same_bits;

/// A disk that can be full, failing or stuck.
class BadDisk {
 public:
  enum class Mood { fine, full, failing, stuck };

  void set(Mood mood) {
    {
      const std::lock_guard lock(mutex_);
      mood_ = mood;
    }
    changed_.notify_all();
  }
  Result<void> take(std::span<const std::uint8_t> bytes, std::ofstream& file) {
    std::unique_lock lock(mutex_);
    ++attempts_;
    changed_.wait(lock, [this] { return mood_ != Mood::stuck; });
    if (mood_ == Mood::full) return fail(ErrorCode::full, "No space left on device");
    if (mood_ == Mood::failing) return fail(ErrorCode::gone, "Input/output error");
    file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    file.flush();
    return {};
  }
  int attempts() const {
    const std::lock_guard lock(mutex_);
    return attempts_;
  }

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  Mood mood_ = Mood::fine;
  int attempts_ = 0;
};

class BadSink final : public RecordSink {
 public:
  BadSink(BadDisk& disk, const std::filesystem::path& file) : disk_(disk), file_(file, std::ios::binary) {}
  Result<void> append(std::span<const std::uint8_t> bytes) override { return disk_.take(bytes, file_); }
  Result<void> sync() override { return {}; }
  std::uint64_t free_bytes() const override { return 1ULL << 40U; }

 private:
  BadDisk& disk_;
  std::ofstream file_;
};

class RecorderTest : public ::testing::Test {
 protected:
  RecorderOptions options() const {
    RecorderOptions o;
    o.folder = folder / "scan";
    o.keep_free = 0;
    return o;
  }
  std::unique_ptr<Recorder> started(const RecorderOptions& o) const {
    auto recorder = Recorder::start(o, made_info());
    EXPECT_TRUE(recorder) << (recorder ? "" : recorder.error().message);
    return recorder ? std::move(*recorder) : nullptr;
  }
  /// Pictures to a bad disk; the rest of the folder on a good one.
  std::unique_ptr<Recorder> started_on(BadDisk& disk, const RecorderOptions& o) const {
    std::filesystem::create_directories(o.folder);
    auto tracker = create_record_file(o.folder / kTrackerFile);
    Recorder::Sinks sinks{std::make_unique<BadSink>(disk, o.folder / kPictureFile), std::move(*tracker)};
    auto recorder = Recorder::start(o, made_info(), std::move(sinks));
    EXPECT_TRUE(recorder);
    return std::move(*recorder);
  }
  /// The test's own time limit ends it otherwise.
  template <class Condition>
  static void wait_until(const Recorder& recorder, Condition condition) {
    while (!condition(recorder.status())) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  std::vector<Frame> recorded_pictures() const {
    RecordedCamera camera(folder / "scan");
    EXPECT_TRUE(camera.start());
    std::vector<Frame> frames;
    for (Frame frame; camera.next(frame).value() == Pull::item; frame = {}) frames.push_back(frame);
    return frames;
  }
  std::vector<PoseSample> recorded_samples() const {
    RecordedTracker tracker(folder / "scan");
    EXPECT_TRUE(tracker.start());
    std::vector<PoseSample> samples;
    for (PoseSample sample; tracker.next(sample).value() == Pull::item;) samples.push_back(sample);
    return samples;
  }

  testing::TemporaryFolder folder;
};

TEST_F(RecorderTest, GivesBackEveryBit) {
  auto recorder = started(options());
  for (std::uint32_t i = 0; i < 40; ++i) {
    recorder->add(made_frame(i));
    for (std::uint32_t k = 0; k < 8; ++k) recorder->add(made_sample(8 * i + k));
  }
  recorder->add_event(123, "clear scan");
  recorder->stop();
  const RecorderStatus status = recorder->status();
  EXPECT_EQ(status.state, RecorderState::stopped);
  EXPECT_EQ(status.counters.lost(), 0U);

  const auto frames = recorded_pictures();
  ASSERT_EQ(frames.size(), 40U);
  for (std::uint64_t i = 0; i < frames.size(); ++i) EXPECT_TRUE(same_bits(frames[i], made_frame(i))) << i;
  const auto samples = recorded_samples();
  ASSERT_EQ(samples.size(), 320U);
  for (std::uint32_t i = 0; i < samples.size(); ++i) ASSERT_TRUE(same_bits(samples[i], made_sample(i))) << i;
  const auto events = read_events(folder / "scan");
  ASSERT_TRUE(events);
  ASSERT_EQ(events->size(), 1U);
  EXPECT_EQ(events->front().text, "clear scan");
}

TEST_F(RecorderTest, FolderSaysWhatItIs) {
  auto recorder = started(options());
  recorder->add(made_frame(0));
  recorder->stop();
  const auto recording = open_recording(folder / "scan");
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_TRUE(recording->complete);
  EXPECT_EQ(recording->totals.pictures, 1U);
  EXPECT_EQ(recording->info.version, "0.1.0");
  EXPECT_EQ(recording->info.camera, "a \"test\" camera");
  EXPECT_EQ(recording->info.configuration, "[camera]\nrate_hz = 30\n");
  EXPECT_EQ(recording->info.camera_period, 33'333'333);
  EXPECT_EQ(recording->info.harvester_station, 2);
  EXPECT_TRUE(same_bits(recording->info.calibration.endoscope_from_camera,
                        made_info().calibration.endoscope_from_camera));
  EXPECT_EQ(recording->remark, "");
  EXPECT_TRUE(load_calibration(folder / "scan" / kCalibrationFile))
      << "and the calibration for people and other tools";
}

TEST_F(RecorderTest, MissingCalibrationRecordFallsBackToTheFileAndSaysSo) {
  started(options())->stop();
  std::filesystem::resize_file(folder / "scan" / kTrackerFile, kRecordFileHeader);
  const auto recording = open_recording(folder / "scan");
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_THAT(recording->remark, HasSubstr("calibration.yaml"));
}

TEST_F(RecorderTest, UsedFolderIsRefused) {
  std::filesystem::create_directories(folder / "scan");
  std::ofstream(folder / "scan" / "notes.txt") << "mine";
  const auto recorder = Recorder::start(options(), made_info());
  ASSERT_FALSE(recorder);
  EXPECT_EQ(recorder.error().code, ErrorCode::busy);
  EXPECT_THAT(recorder.error().message, HasSubstr("is not empty"));
}

TEST_F(RecorderTest, TooLittleRoomIsToldBeforeTheStart) {
  RecorderOptions o = options();
  o.keep_free = 1ULL << 62U;
  const auto recorder = Recorder::start(o, made_info());
  ASSERT_FALSE(recorder);
  EXPECT_EQ(recorder.error().code, ErrorCode::full);
}

TEST_F(RecorderTest, PicturesThatCannotBeKeptAreCounted) {
  auto recorder = started(options());
  Frame frame = made_frame(0);
  frame.bgr = cv::Mat(4, 4, CV_8UC1);
  recorder->add(frame);
  recorder->add(Frame{});
  recorder->stop();
  EXPECT_EQ(recorder->status().counters.pictures_refused, 2U);
  EXPECT_EQ(open_recording(folder / "scan")->totals.lost, 2U);
}

TEST_F(RecorderTest, StuckDiskNeverHoldsUpTheCaptureAndEveryLossIsCounted) {
  BadDisk disk;
  RecorderOptions o = options();
  o.picture_queue = 8;
  auto recorder = started_on(disk, o);
  disk.set(BadDisk::Mood::stuck);
  recorder->add(made_frame(0));
  while (disk.attempts() == 0) std::this_thread::yield();
  // The writing thread now hangs in the disk; add() must return all the same, for pictures and samples.
  for (std::uint64_t i = 1; i <= 100; ++i) recorder->add(made_frame(i));
  for (std::uint32_t i = 0; i < 20'000; ++i) recorder->add(made_sample(i));
  const RecorderCounters stuck = recorder->status().counters;
  EXPECT_GT(stuck.pictures_lost_queue, 90U);
  EXPECT_GT(stuck.samples_lost_queue, 11'000U);
  disk.set(BadDisk::Mood::fine);
  wait_until(*recorder, [](const RecorderStatus& s) { return s.state == RecorderState::slow; });
  EXPECT_THAT(recorder->status().reason, HasSubstr("too slow"));
  recorder->stop();
  const RecorderCounters c = recorder->status().counters;
  EXPECT_EQ(c.pictures + c.pictures_lost_queue, 101U) << "written or counted, nothing in silence";
  EXPECT_EQ(c.samples + c.samples_lost_queue, 20'000U);
  EXPECT_EQ(recorded_pictures().size(), c.pictures);
  EXPECT_EQ(recorded_samples().size(), c.samples);
}

struct BadMood {
  BadDisk::Mood mood;
  RecorderState state;
};
class RecorderBadDisk : public RecorderTest, public ::testing::WithParamInterface<BadMood> {};

TEST_P(RecorderBadDisk, IsAStateAndTheRecordingGoesOnAfterwards) {
  BadDisk disk;
  auto recorder = started_on(disk, options());
  recorder->add(made_frame(0));
  wait_until(*recorder, [](const RecorderStatus& s) { return s.counters.pictures == 1; });
  disk.set(GetParam().mood);
  recorder->add(made_frame(1));
  wait_until(*recorder, [](const RecorderStatus& s) { return s.counters.pictures_lost_disk == 1; });
  EXPECT_EQ(recorder->status().state, GetParam().state);
  EXPECT_THAT(recorder->status().reason, HasSubstr("the scan goes on"));
  recorder->add(made_frame(2));
  wait_until(*recorder, [](const RecorderStatus& s) { return s.counters.pictures_lost_disk == 2; });
  disk.set(BadDisk::Mood::fine);
  wait_until(*recorder, [](const RecorderStatus& s) { return s.state == RecorderState::recording; });
  EXPECT_EQ(recorder->status().reason, "");
  recorder->add(made_frame(3));
  recorder->stop();
  const auto frames = recorded_pictures();
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0].index, 0U);
  EXPECT_EQ(frames[1].index, 3U);
}
INSTANTIATE_TEST_SUITE_P(Moods, RecorderBadDisk,
                         ::testing::Values(BadMood{BadDisk::Mood::full, RecorderState::disk_full},
                                           BadMood{BadDisk::Mood::failing, RecorderState::failed}),
                         [](const auto& test) { return test.index == 0 ? "Full" : "Failing"; });

/// The real file and a real refusal of the kernel: a limit on the size of files stands for a full disk or a
/// quota.
TEST_F(RecorderTest, FileThatMayNotGrowKeepsItsWholePictures) {
  RecorderOptions o = options();
  o.compress = false;
  rlimit old{};
  getrlimit(RLIMIT_FSIZE, &old);
  const rlimit small{100'000, old.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  auto recorder = started(o);
  for (std::uint64_t i = 0; i < 20; ++i) recorder->add(made_frame(i));  // 9216 bytes each
  wait_until(*recorder, [](const RecorderStatus& s) {
    return s.counters.pictures + s.counters.pictures_lost_disk == 20;
  });
  const RecorderStatus status = recorder->status();
  setrlimit(RLIMIT_FSIZE, &old);
  recorder->stop();
  EXPECT_EQ(status.state, RecorderState::disk_full);
  EXPECT_EQ(status.counters.pictures, 10U);
  EXPECT_THAT(status.reason, HasSubstr("File too large"));
  EXPECT_EQ(recorded_pictures().size(), 10U);
  const auto size = std::filesystem::file_size(folder / "scan" / kPictureFile);
  EXPECT_LT(size, 100'000U) << "the record that did not fit is cut off again";
}

/// Everything that the recorder counted as written when the process was killed is there afterwards.
TEST_F(RecorderTest, KilledProcessLosesNothingThatWasCountedAsWritten) {
  int channel[2];
  ASSERT_EQ(::pipe(channel), 0);
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    auto recorder = Recorder::start(options(), made_info());
    for (std::uint64_t i = 0; recorder; ++i) {
      (*recorder)->add(made_frame(i));
      (*recorder)->add(made_sample(static_cast<std::uint32_t>(i)));
      while ((*recorder)->status().counters.pictures <= i) std::this_thread::yield();
      while ((*recorder)->status().counters.samples <= i) std::this_thread::yield();
      if (::write(channel[1], "x", 1) != 1) ::_exit(1);
    }
    ::_exit(2);
  }
  char byte = 0;
  for (int i = 0; i < 50; ++i) ASSERT_EQ(::read(channel[0], &byte, 1), 1) << "the child ended early";
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);

  const auto recording = open_recording(folder / "scan");
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_FALSE(recording->complete);
  EXPECT_THAT(recording->remark, HasSubstr("was not closed"));
  const auto frames = recorded_pictures();
  ASSERT_GE(frames.size(), 50U);
  for (std::uint64_t i = 0; i < frames.size(); ++i) ASSERT_TRUE(same_bits(frames[i], made_frame(i))) << i;
  EXPECT_GE(recorded_samples().size(), 50U);
}

TEST_F(RecorderTest, CutRecordingPlaysItsGoodPartAndSaysSo) {
  auto recorder = started(options());
  for (std::uint64_t i = 0; i < 10; ++i) recorder->add(made_frame(i));
  recorder->stop();
  const auto file = folder / "scan" / kPictureFile;
  std::filesystem::resize_file(file, std::filesystem::file_size(file) - 100);
  RecordedCamera camera(folder / "scan");
  ASSERT_TRUE(camera.start());
  Frame frame;
  for (int i = 0; i < 9; ++i) ASSERT_EQ(camera.next(frame).value(), Pull::item);
  ASSERT_EQ(camera.next(frame).value(), Pull::end);
  EXPECT_EQ(camera.next(frame).value(), Pull::end);
  EXPECT_EQ(camera.status().reason,
            "9 pictures were read; the recording was cut off in the middle of the next one");
}

TEST_F(RecorderTest, DamageInTheMiddleCostsOnePictureAndIsCounted) {
  auto recorder = started(options());
  for (std::uint64_t i = 0; i < 10; ++i) recorder->add(made_frame(i));
  recorder->stop();
  const auto file = folder / "scan" / kPictureFile;
  std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
  stream.seekp(static_cast<std::streamoff>(std::filesystem::file_size(file) / 2));
  stream.put('\x55').put('\xAA');
  stream.close();
  RecordedCamera camera(folder / "scan");
  ASSERT_TRUE(camera.start());
  Frame frame;
  int good = 0, bad = 0;
  for (;;) {
    const auto pull = camera.next(frame);
    if (pull && *pull == Pull::end) break;
    EXPECT_TRUE(pull || pull.error().code == ErrorCode::unreadable);
    ++(pull ? good : bad);
  }
  EXPECT_EQ(good, 9);
  EXPECT_EQ(bad, 1);
  EXPECT_EQ(camera.status().counters.unreadable, 1U);
}

TEST_F(RecorderTest, WhatIsNoRecordingIsASentence) {
  EXPECT_EQ(open_recording(folder / "none").error().code, ErrorCode::not_found);
  EXPECT_THAT(open_recording(folder.path()).error().message,
              HasSubstr("is not a recording: it has no recording.toml"));
  EXPECT_EQ(RecordedCamera(folder / "none").start().error().code, ErrorCode::not_found);
  EXPECT_EQ(RecordedTracker(folder / "none").start().error().code, ErrorCode::not_found);
  std::filesystem::create_directories(folder / "newer");
  std::ofstream(folder / "newer" / kInfoFile) << "[recording]\nformat = 99\nversion = '7.0'\n";
  EXPECT_THAT(open_recording(folder / "newer").error().message, HasSubstr("use linescope 7.0 or newer"));
}

TEST_F(RecorderTest, HeadsSkipThePixels) {
  auto recorder = started(options());
  for (std::uint64_t i = 0; i < 3; ++i) recorder->add(made_frame(i));
  recorder->stop();
  RecordedCamera camera(folder / "scan");
  ASSERT_TRUE(camera.start());
  PictureHead head;
  for (std::uint64_t i = 0; i < 3; ++i) {
    ASSERT_EQ(camera.next_head(head).value(), Pull::item);
    EXPECT_EQ(head.index, i);
    EXPECT_EQ(head.time, made_frame(i).time);
  }
  EXPECT_EQ(camera.next_head(head).value(), Pull::end);
}

TEST_F(RecorderTest, ImpossibleOptionsAreRefused) {
  EXPECT_FALSE(validate(RecorderOptions{}));
  EXPECT_FALSE(validate(RecorderOptions{.folder = "x", .picture_queue = 0}));
  EXPECT_FALSE(validate(RecorderOptions{.folder = "x", .sample_queue = 1}));
  EXPECT_FALSE(validate(RecorderOptions{.folder = "x", .sync_every = 0}));
}

}  // namespace
}  // namespace linescope
