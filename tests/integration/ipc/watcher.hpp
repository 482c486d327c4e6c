// A reader as a viewer is one: attaches, reads lines, notices death, attaches to the successor by itself;
// keeps account.
#pragma once

#include <atomic>
#include <string>
#include <thread>

#include "ipc/segment_reader.hpp"
#include "tests/integration/ipc/made_up_line.hpp"

namespace linescope::testing {

/// What a whole line looks like, beyond its checksum.
using LineCheck = bool (*)(const Line&, std::span<const SurfacePoint>);

struct WatcherAccount {
  std::uint64_t lines = 0;        ///< good ones
  std::uint64_t torn = 0;         ///< not as a whole line looks
  std::uint64_t damaged = 0;      ///< wrong checksum
  std::uint64_t repeated = 0;     ///< a serial that was there already
  std::uint64_t unexplained = 0;  ///< serials neither delivered nor counted as missed
  std::uint64_t corrupt = 0;      ///< reads refused as corrupt
  std::uint64_t sessions = 0;     ///< writers seen
  Nanoseconds longest_hang = 0;   ///< longest single call
};

class Watcher {
 public:
  explicit Watcher(std::string name, LineCheck whole = is_made_up);
  ~Watcher();
  Watcher(const Watcher&) = delete;
  Watcher& operator=(const Watcher&) = delete;

  /// Session it is attached to with a living writer; 0: none.
  std::uint64_t alive() const { return alive_; }
  /// Lines it got of the present writer.
  std::uint64_t lines_of_this_writer() const { return lines_of_this_writer_; }
  /// When it last looked and found its writer alive. However busy the machine is: no look later than 0.2 s
  /// after a death may.
  Nanoseconds last_alive() const { return last_alive_; }
  /// When it last noticed that its writer does not live any more.
  Nanoseconds noticed() const { return noticed_; }
  /// Ends and gives the account.
  const WatcherAccount& finish();

 private:
  void run();
  void follow(SegmentReader& reader);
  void lose();
  void check(const LineBatch& batch, const LineCursor& cursor);

  std::string name_;
  LineCheck whole_;
  WatcherAccount account_;
  std::uint64_t next_serial_ = 0;
  std::atomic<std::uint64_t> alive_{0};
  std::atomic<std::uint64_t> lines_of_this_writer_{0};
  std::atomic<Nanoseconds> last_alive_{0};
  std::atomic<Nanoseconds> noticed_{0};
  std::atomic<bool> end_{false};
  std::thread thread_;
};

}  // namespace linescope::testing
