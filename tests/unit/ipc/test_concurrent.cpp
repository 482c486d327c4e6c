// Writer threads and readers at full speed within one process: what ThreadSanitizer is to look at. Every
// reader checks that what it gets is whole.
#include <atomic>
#include <thread>

#include "ipc/control.hpp"
#include "ipc/heartbeat.hpp"
#include "tests/unit/ipc/segment_fixture.hpp"

namespace linescope::testing {
namespace {

class Concurrent : public SegmentTest {
 protected:
  void SetUp() override {
    SegmentTest::SetUp();
    writer_->set_scanning(true);
  }

  /// Runs `publish` in a thread until every reader has had `rounds` successful reads.
  template <class Publish, class Read>
  void race(const Publish& publish, const Read& read, int rounds, int readers = 2) {
    std::atomic<int> busy{readers};
    std::vector<std::thread> threads;
    for (int r = 0; r < readers; ++r) {
      threads.emplace_back([&] {
        SegmentReader mine = attach();
        for (int done = 0; done < rounds && !HasFatalFailure();) {
          if (read(mine))
            ++done;
          else
            std::this_thread::yield();  // the writer's turn
        }
        --busy;
      });
    }
    for (int i = 0; busy > 0; ++i) publish(i);
    for (std::thread& thread : threads) thread.join();
  }
};

TEST_F(Concurrent, PosesAreNeverTorn) {
  race(
      [&](int i) {
        PoseSample s;
        s.time = i;
        s.frame_count = static_cast<std::uint32_t>(i);
        s.world_from_sensor = {Eigen::Quaterniond::Identity(), Eigen::Vector3d::Constant(i)};
        writer_->publish_pose(s);
      },
      [](const SegmentReader& reader) {
        PoseSample s;
        if (reader.latest_pose(0, s) != ReadOutcome::ok) return false;
        EXPECT_EQ(s.world_from_sensor.translation(), Eigen::Vector3d::Constant(static_cast<double>(s.time)));
        EXPECT_EQ(s.frame_count, static_cast<std::uint32_t>(s.time));
        return true;
      },
      3'000);
}

TEST_F(Concurrent, HistoriesHaveNoGapsAndNoRepetitions) {
  race(
      [&](int i) {
        PoseSample s;
        s.time = i;
        writer_->publish_pose(s);
      },
      [](const SegmentReader& reader) {
        std::vector<PoseSample> history;
        if (reader.pose_history(0, 0, 1'000'000'000, history) == ReadOutcome::nothing) return false;
        for (std::size_t i = 1; i < history.size(); ++i) EXPECT_EQ(history[i].time, history[i - 1].time + 1);
        return !history.empty();
      },
      1'000);
}

/// The ring holds 16 samples and the writer never pauses: readers are overtaken all the time, and told
/// exactly by how much.
TEST_F(Concurrent, EverySampleIsDeliveredOnceOrCountedAsMissed) {
  race(
      [&](int i) {
        PoseSample s;
        s.time = i;
        writer_->publish_pose(s);
      },
      [](const SegmentReader& reader) {
        thread_local PoseCursor cursor;
        thread_local std::vector<PoseSample> samples;
        samples.clear();
        Nanoseconds expected =
            cursor.session_id == reader.identity().session_id ? static_cast<Nanoseconds>(cursor.next) : 0;
        std::uint64_t missed = 0;
        if (reader.new_poses(0, cursor, samples, missed) != ReadOutcome::ok) return false;
        expected += static_cast<Nanoseconds>(missed);
        for (const PoseSample& s : samples) EXPECT_EQ(s.time, expected++);
        EXPECT_EQ(expected, static_cast<Nanoseconds>(cursor.next));
        return true;
      },
      300);
}

TEST_F(Concurrent, PicturesAreNeverTorn) {
  std::vector<std::byte> pixels(64 * 48);
  race(
      [&](int i) {
        std::fill(pixels.begin(), pixels.end(), static_cast<std::byte>(i & 0xff));
        writer_->publish_picture({.time = i, .width = 64, .height = 48, .format = PixelFormat::gray8},
                                 pixels.data(), 64, {});
      },
      [](const SegmentReader& reader) {
        Picture picture;
        if (reader.picture(picture) != ReadOutcome::ok) return false;
        const auto wanted = static_cast<std::byte>(picture.time & 0xff);
        EXPECT_TRUE(std::all_of(picture.pixels.begin(), picture.pixels.end(),
                                [&](std::byte b) { return b == wanted; }));
        return true;
      },
      300);
}

/// Scans that are full after 50 lines, cleared and undone all the time: every delivered line is whole,
/// serials never repeat unless the scan restarted, and delivered + missed is everything.
TEST_F(Concurrent, LinesAreWholeAndFullyAccountedFor) {
  struct Account {
    LineCursor cursor;
    LineBatch batch;
    std::uint64_t next = 0;
  };
  const auto check = [](Account& account, const SegmentReader& reader) {
    if (reader.read_lines(account.cursor, account.batch) != ReadOutcome::ok) return false;
    EXPECT_EQ(account.batch.damaged, 0U);
    std::uint64_t fresh = 0;
    for (const Line& line : account.batch.lines) {
      expect_points(account.batch.points_of(line), static_cast<int>(line.frame), 1 + line.frame % 60);
      fresh += line.serial >= account.next ? 1 : 0;
    }
    account.next += fresh + account.batch.missed;
    EXPECT_EQ(account.next, account.cursor.next_serial) << "every serial was delivered or counted as missed";
    return true;
  };
  race(
      [&](int i) {
        const int seed = i % 100'000;
        const PublishOutcome outcome = publish(seed, 1 + static_cast<std::size_t>(seed) % 60);
        if (outcome == PublishOutcome::full || i % 97 == 0) writer_->begin_scan(i);
        if (i % 31 == 0) writer_->undo_to(writer_->lines_in_scan() / 2);
      },
      [&](const SegmentReader& reader) {
        thread_local Account account;
        if (account.cursor.session_id != reader.identity().session_id) account = {};
        return check(account, reader);
      },
      200);
}

TEST_F(Concurrent, StatesTextsCountersAndHeartbeatGoOnTogether) {
  const Heartbeat heartbeat(*writer_);
  race(
      [&](int i) {
        const std::string word(static_cast<std::size_t>(i % 200), static_cast<char>('a' + i % 26));
        writer_->set_state(DaemonState::scanning, word);
        writer_->publish_configuration(word);
        writer_->count(Counter::frames_received);
        writer_->record_latency(LatencyStage::extract, i);
      },
      [](SegmentReader& reader) {
        DaemonStatus status;
        std::string text;
        if (reader.status(status) == ReadOutcome::ok) {
          EXPECT_EQ(status.reason,
                    std::string(status.reason.size(), status.reason.empty() ? 'x' : status.reason[0]));
        }
        if (reader.configuration(text) == ReadOutcome::ok) {
          EXPECT_EQ(text, std::string(text.size(), text.empty() ? 'x' : text[0]));
        }
        const Life life = reader.life(monotonic_now());
        EXPECT_TRUE(life == Life::live || life == Life::silent) << name(life) << ": starved at the most";
        return reader.wait(Topic::status, kMillisecond) && reader.counters().size() == LS_COUNTER_COUNT;
      },
      500);
}

}  // namespace
}  // namespace linescope::testing
