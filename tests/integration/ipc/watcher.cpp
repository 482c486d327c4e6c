#include "tests/integration/ipc/watcher.hpp"

#include <algorithm>

#include "tests/integration/ipc/made_up_line.hpp"

namespace linescope::testing {

Watcher::Watcher(std::string name) : name_(std::move(name)), thread_([this] { run(); }) {}

Watcher::~Watcher() {
  finish();
}

const WatcherAccount& Watcher::finish() {
  end_ = true;
  if (thread_.joinable()) thread_.join();
  return account_;
}

void Watcher::run() {
  std::uint64_t last_session = 0;
  while (!end_) {
    auto reader = SegmentReader::attach({.name = name_});
    if (!reader || reader->life(monotonic_now()) != Life::live ||
        reader->identity().session_id == last_session) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      continue;
    }
    last_session = reader->identity().session_id;
    ++account_.sessions;
    next_serial_ = 0;
    alive_ = last_session;
    follow(*reader);
    noticed_ = monotonic_now();
    alive_ = 0;
  }
}

void Watcher::follow(SegmentReader& reader) {
  LineCursor cursor;
  LineBatch batch;
  while (!end_) {
    const Nanoseconds start = monotonic_now();
    const ReadOutcome outcome = reader.read_lines(cursor, batch);
    account_.longest_hang = std::max(account_.longest_hang, monotonic_now() - start);
    account_.corrupt += outcome == ReadOutcome::corrupt;
    if (outcome == ReadOutcome::ok) check(batch, cursor);
    if (reader.life(monotonic_now()) != Life::live) return;
    if (outcome != ReadOutcome::ok) reader.wait(Topic::lines, 20 * kMillisecond);
  }
}

void Watcher::check(const LineBatch& batch, const LineCursor& cursor) {
  account_.damaged += batch.damaged;
  for (const Line& line : batch.lines) {
    (is_made_up(line, batch.points_of(line)) ? account_.lines : account_.torn) += 1;
    account_.repeated += line.serial < next_serial_;
  }
  const std::uint64_t explained = next_serial_ + batch.lines.size() + batch.damaged + batch.missed;
  account_.unexplained +=
      cursor.next_serial > explained ? cursor.next_serial - explained : explained - cursor.next_serial;
  next_serial_ = cursor.next_serial;
}

}  // namespace linescope::testing
