#include "tests/integration/ipc/watcher.hpp"

#include <algorithm>

namespace linescope::testing {

Watcher::Watcher(std::string name, LineCheck whole)
    : name_(std::move(name)), whole_(whole), thread_([this] { run(); }) {}

Watcher::~Watcher() {
  finish();
}

const WatcherAccount& Watcher::finish() {
  end_ = true;
  if (thread_.joinable()) thread_.join();
  return account_;
}

void Watcher::run() {
  while (!end_) {
    auto reader = SegmentReader::attach({.name = name_});
    if (!reader || reader->life(monotonic_now()) != Life::live) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      continue;
    }
    ++account_.sessions;
    next_serial_ = 0;
    follow(*reader);
    lose();
  }
}

/// Notes the moment at which the writer was found not to live any more.
void Watcher::lose() {
  if (alive_ == 0) return;
  noticed_ = monotonic_now();
  lines_of_this_writer_ = 0;
  alive_ = 0;
}

/// Until the writer has ended or was replaced. One that is only silent may come back: on a busy machine its
/// heart may pause.
void Watcher::follow(SegmentReader& reader) {
  LineCursor cursor;
  LineBatch batch;
  while (!end_) {
    const Nanoseconds now = monotonic_now();
    const Life life = reader.life(now);
    if (life != Life::live) {
      lose();
      if (life != Life::silent) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      continue;
    }
    last_alive_ = now;
    alive_ = reader.identity().session_id;
    const Nanoseconds start = monotonic_now();
    const ReadOutcome outcome = reader.read_lines(cursor, batch);
    account_.longest_hang = std::max(account_.longest_hang, monotonic_now() - start);
    account_.corrupt += outcome == ReadOutcome::corrupt;
    if (outcome == ReadOutcome::ok) check(batch, cursor);
    if (outcome != ReadOutcome::ok) reader.wait(Topic::lines, 20 * kMillisecond);
  }
}

void Watcher::check(const LineBatch& batch, const LineCursor& cursor) {
  account_.damaged += batch.damaged;
  lines_of_this_writer_ += batch.lines.size();
  for (const Line& line : batch.lines) {
    (whole_(line, batch.points_of(line)) ? account_.lines : account_.torn) += 1;
    account_.repeated += line.serial < next_serial_;
  }
  const std::uint64_t explained = next_serial_ + batch.lines.size() + batch.damaged + batch.missed;
  account_.unexplained +=
      cursor.next_serial > explained ? cursor.next_serial - explained : explained - cursor.next_serial;
  next_serial_ = cursor.next_serial;
}

}  // namespace linescope::testing
