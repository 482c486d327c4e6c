#include "viewer/command_courier.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace linescope {

void CommandCourier::tell(Nanoseconds now, Notice::Kind kind, std::string text) {
  notices_.put({now, kind, std::move(text)});
}

void CommandCourier::run(const SegmentReader* reader, Nanoseconds now) {
  for (const Command& command : orders_.take()) {
    if (reader != nullptr)
      send(command, *reader, now);
    else
      tell(now, Notice::Kind::refusal,
           fmt::format("\"{}\" was not sent: no daemon is attached. Start linescope-acquire.",
                       name(command.kind)));
  }
  std::erase_if(open_, [&](const Open& open) { return settled(open, now); });
}

void CommandCourier::send(const Command& command, const SegmentReader& reader, Nanoseconds now) {
  if (!client_) {
    auto client = ControlClient::open(reader);
    if (!client) return tell(now, Notice::Kind::refusal, client.error().message);
    client_.emplace(std::move(*client));
  }
  auto id = client_->send(command);
  if (!id) return tell(now, Notice::Kind::refusal, id.error().message);
  open_.push_back({*id, command.kind, now});
}

bool CommandCourier::settled(const Open& open, Nanoseconds now) {
  const CommandAnswer answer = client_->answer(open.id);
  if (answer.kind == AnswerKind::pending) {
    // Saving takes as long as the disk does.
    if (now - open.sent < kAnswerWithin || open.kind == CommandKind::save) return false;
    tell(now, Notice::Kind::refusal,
         fmt::format("The daemon did not answer \"{}\" within 2 s.", name(open.kind)));
    return true;
  }
  const bool done = answer.kind == AnswerKind::done;
  const std::string what = answer.text.empty() ? std::string(name(answer.kind)) : answer.text;
  tell(now, done ? Notice::Kind::information : Notice::Kind::refusal,
       fmt::format("{}: {}", name(open.kind), what));
  return true;
}

void CommandCourier::hang_up(Nanoseconds now) {
  for (const Open& open : open_)
    tell(now, Notice::Kind::refusal,
         fmt::format("\"{}\" was not answered: the daemon is gone.", name(open.kind)));
  open_.clear();
  client_.reset();
}

}  // namespace linescope
