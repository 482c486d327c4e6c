// Commands from viewers to the daemon, through the control segment (ipc/control_layout.h): lock-free, an
// answer for each, and nothing lost by whoever dies half way.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "common/result.hpp"
#include "common/time.hpp"
#include "ipc/control_layout.h"

namespace linescope {

class SegmentWriter;
class SegmentReader;

enum class CommandKind : std::uint32_t {
  start = LS_COMMAND_START,                        ///< take lines
  stop = LS_COMMAND_STOP,                          ///< pause
  clear = LS_COMMAND_CLEAR,                        ///< throw the scan away
  new_scan = LS_COMMAND_NEW_SCAN,                  ///< begin the next one
  undo_sweep = LS_COMMAND_UNDO_SWEEP,              ///< take back what was scanned since the last start
  save = LS_COMMAND_SAVE,                          ///< text: file
  exposure = LS_COMMAND_EXPOSURE,                  ///< number: ms
  laser_brightness = LS_COMMAND_LASER_BRIGHTNESS,  ///< number: 0 .. 1
  shut_down = LS_COMMAND_SHUT_DOWN,
};
std::string_view name(CommandKind kind);

struct Command {
  CommandKind kind = CommandKind::stop;
  double number = 0;
  std::string text;  ///< at most 87 bytes
};

/// Running number of a command within a session; never 0.
using CommandId = std::uint64_t;

enum class AnswerKind {
  pending,  ///< not answered yet
  done,
  refused,  ///< with the reason in the text
  unknown,  ///< the daemon does not know this command
  lost,     ///< no such command: collected already, dropped because nobody collected it, or the daemon was
            ///< replaced
};
std::string_view name(AnswerKind kind);

struct CommandAnswer {
  AnswerKind kind = AnswerKind::done;
  std::string text;  ///< one sentence; cut at 111 bytes
};

/// The viewer's end. One object per thread.
class ControlClient {
 public:
  /// To the control segment of the writer that `reader` is attached to.
  static Result<ControlClient> open(const SegmentReader& reader);
  ~ControlClient();
  ControlClient(ControlClient&&) noexcept;
  ControlClient& operator=(ControlClient&&) noexcept;

  /// `full` when 64 commands are waiting, `usage` when the text is too long, `invalid` when the number is not
  /// finite.
  Result<CommandId> send(const Command& command);
  /// Never waits. Any answer but pending is given once.
  CommandAnswer answer(CommandId id);
  /// Waits for the answer; `timeout` when there is none in time. The command may still be carried out later.
  Result<CommandAnswer> await(CommandId id, Nanoseconds timeout);

 private:
  struct Parts;
  explicit ControlClient(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

/// A command as it arrives at the daemon.
struct ReceivedCommand : Command {
  CommandId id = 0;
  std::uint32_t sender_pid = 0;
  Nanoseconds sent = 0;
};

/// The daemon's end, one thread. Counts commands in the writer's counters. `writer` must live longer.
class ControlServer {
 public:
  explicit ControlServer(SegmentWriter& writer);
  ~ControlServer();
  ControlServer(const ControlServer&) = delete;
  ControlServer& operator=(const ControlServer&) = delete;

  /// Called in the order of sending. Returning `pending` postpones: answer(id) follows later.
  using Handler = std::function<CommandAnswer(const ReceivedCommand&)>;

  /// Carries out everything that is waiting; returns how many. Never waits. Also clears up behind senders
  /// that died.
  int poll(Nanoseconds now, const Handler& handler);
  /// Sleeps until a command is there or the time is over. True: there is one.
  bool wait(Nanoseconds timeout);
  /// The late answer to a postponed command.
  void answer(CommandId id, const CommandAnswer& answer);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace linescope
