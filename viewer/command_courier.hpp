// Carries the operator's commands to the daemon and the daemon's answers back, without anybody waiting.
#pragma once

#include <optional>
#include <vector>

#include "ipc/control.hpp"
#include "ipc/segment_reader.hpp"
#include "viewer/latest.hpp"
#include "viewer/view_state.hpp"

namespace linescope {

/// A command without an answer for this long is reported as unanswered.
inline constexpr Nanoseconds kAnswerWithin = 2 * kSecond;

class CommandCourier {
 public:
  /// Any thread.
  void order(Command command) { orders_.put(std::move(command)); }
  std::vector<Notice> take_notices() { return notices_.take(); }

  /// The acquisition thread: sends what was ordered, collects answers. `reader` null: no daemon, orders are
  /// refused.
  void run(const SegmentReader* reader, Nanoseconds now);
  /// The daemon is gone: open commands will not be answered.
  void hang_up(Nanoseconds now);

 private:
  struct Open {
    CommandId id;
    CommandKind kind;
    Nanoseconds sent;
  };
  void send(const Command& command, const SegmentReader& reader, Nanoseconds now);
  bool settled(const Open& open, Nanoseconds now);
  void tell(Nanoseconds now, Notice::Kind kind, std::string text);

  Inbox<Command> orders_;
  Inbox<Notice> notices_;
  std::optional<ControlClient> client_;
  std::vector<Open> open_;
};

}  // namespace linescope
