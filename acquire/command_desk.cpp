#include "acquire/command_desk.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace linescope {
namespace {

CommandAnswer done(std::string text = {}) {
  return {AnswerKind::done, std::move(text)};
}
CommandAnswer refused(std::string why) {
  return {AnswerKind::refused, std::move(why)};
}

}  // namespace

CommandDesk::CommandDesk(SegmentWriter& writer, ScanControl& scan, LaserWatch& laser, std::atomic<bool>& stop)
    : scan_(scan), laser_(laser), stop_(stop), server_(writer), saver_(writer.name()) {}

void CommandDesk::attend(Nanoseconds now) {
  finish_save();
  server_.poll(now, [&](const ReceivedCommand& command) {
    CommandAnswer answer = carry_out(command, now);
    spdlog::info("command {} from pid {}: {} {}", name(command.kind), command.sender_pid, name(answer.kind),
                 answer.text);
    if (recorder_ != nullptr)
      recorder_->add_event(now, fmt::format("{}: {}", name(command.kind), name(answer.kind)));
    return answer;
  });
}

CommandAnswer CommandDesk::carry_out(const ReceivedCommand& command, Nanoseconds now) {
  switch (command.kind) {
    case CommandKind::start:
      scan_.start(now);
      return done();
    case CommandKind::stop:
      scan_.stop();
      return done();
    case CommandKind::clear:
      scan_.clear(now);
      return done();
    case CommandKind::new_scan:
      scan_.new_scan(now);
      return done();
    case CommandKind::undo_sweep:
      return scan_.undo_sweep() ? done() : refused("there is no sweep to take back");
    case CommandKind::save:
      return save(command);
    case CommandKind::exposure:
      return expose(command.number);
    case CommandKind::laser_brightness:
      return refused("this laser has no remote control: set its supply voltage by hand");
    case CommandKind::shut_down:
      stop_ = true;
      return done();
  }
  return {AnswerKind::unknown, "this daemon does not know that command"};
}

CommandAnswer CommandDesk::save(const ReceivedCommand& command) {
  if (command.text.empty()) return refused("save needs a file name");
  if (auto begun = saver_.begin(command.text); !begun) return refused(begun.error().message);
  saving_ = command.id;
  return {AnswerKind::pending, {}};
}

void CommandDesk::finish_save() {
  auto outcome = saver_.finished();
  if (!outcome) return;
  const bool good = outcome->has_value();
  server_.answer(saving_,
                 good ? done(fmt::format("{} points saved", **outcome)) : refused(outcome->error().message));
}

CommandAnswer CommandDesk::expose(double milliseconds) {
  auto set = laser_.expose(milliseconds);
  return set ? done() : refused(set.error().message);
}

}  // namespace linescope
