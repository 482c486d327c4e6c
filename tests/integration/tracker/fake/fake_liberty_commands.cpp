// The scripted LIBERTY's side of the conversation: what a command does, and what it answers.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "tests/integration/tracker/fake/byte_append.hpp"
#include "tests/integration/tracker/fake/fake_liberty.hpp"

namespace linescope::testing {
namespace {

template <class Container>
std::vector<std::uint8_t> packed(const Container& values) {
  std::vector<std::uint8_t> out;
  for (const auto value : values) append(out, value);
  return out;
}

std::vector<double> numbers_after(const std::string& command, std::size_t start) {
  std::vector<double> values;
  for (std::size_t at = start; at < command.size();) {
    const std::size_t comma = std::min(command.find(',', at), command.size());
    const std::string part = command.substr(at, comma - at);
    values.push_back(part == "*" || part.empty() ? 0 : std::stod(part));
    at = comma + 1;
  }
  return values;
}

std::vector<std::uint8_t> bytes_from(const std::string& text) {
  return {text.begin(), text.end()};
}

std::string readable(const std::string& command) {
  std::string text;
  for (const char c : command)
    text += c < ' ' ? std::string{'^', static_cast<char>(c + '@')} : std::string(1, c);
  return text;
}

}  // namespace

void FakeLiberty::execute(const std::string& command) {
  commands_.push_back(readable(command));
  if (command.empty()) return refuse_with('\r', 0x01, "Invalid Command\r\n");
  const char letter = static_cast<char>(std::toupper(static_cast<unsigned char>(command[0])));
  if (const std::uint8_t error = refused_[static_cast<std::size_t>(letter)]; error != 0 && command.size() > 1)
    return refuse_with(static_cast<std::uint8_t>(letter), error, "Refused\r\n");
  if (letter < ' ') return execute_control(command);
  if (letter == 'C') {
    streaming_ = true;
    return;
  }
  const std::size_t start = letter == '@' ? 2 : 1;
  const std::vector<double> values = numbers_after(command, start);
  const bool question = values.empty() || (values.size() == 1 && (letter == 'O' || letter == 'H'));
  if (!question && ignored_.find(letter) != std::string::npos) return;
  execute_setting(letter, values, !question);
}

void FakeLiberty::execute_setting(char letter, const std::vector<double>& values, bool has_values) {
  const auto code = static_cast<std::uint8_t>(letter);
  const int station = values.empty() ? 0 : static_cast<int>(values[0]);
  const auto reals = [&](auto& target, std::size_t from) {
    for (std::size_t i = 0; i < target.size() && from + i < values.size(); ++i)
      target[i] = static_cast<float>(values[from + i]);
  };
  const auto number = [&](int value) {
    answer(code, 0, packed(std::array{value}), fmt::format("{}", value));
  };
  switch (letter) {
    case 'F':
      if (has_values) settings_.binary = values[0] == 1;
      return;
    case 'U':
      return has_values ? void(settings_.centimetres = values[0] == 1) : number(settings_.centimetres);
    case 'R':
      return has_values ? void(settings_.rate = static_cast<int>(values[0])) : number(settings_.rate);
    case '@':
      return has_values ? void(settings_.fifo = values[0] == 1) : number(settings_.fifo);
    case 'H':
      if (has_values) return reals(settings_.hemisphere, 1);
      return answer(code, station, packed(settings_.hemisphere), "");
    case 'X':
      if (has_values) return reals(settings_.position_filter, 0);
      return answer(code, 0, packed(settings_.position_filter), "");
    case 'Y':
      if (has_values) return reals(settings_.attitude_filter, 0);
      return answer(code, 0, packed(settings_.attitude_filter), "");
    case 'O': {
      if (has_values) {
        settings_.items.assign(values.begin() + 1, values.end());
        return;
      }
      std::vector<int> list = settings_.items;
      list.push_back(-1);
      return answer(code, station, packed(list), "");
    }
    case 'Q':
      frame_ = 0;
      return;
    case 'L':
    case 'G':
    case 'N':
      return;
    default:
      return refuse_with(code, 0x01, "Invalid Command\r\n");
  }
}

void FakeLiberty::execute_control(const std::string& command) {
  const auto code = static_cast<std::uint8_t>(command[0]);
  switch (code) {
    case 0x05:
      settings_.echo = command.ends_with('1');
      return;
    case 0x12:
    case 0x02:
      return;
    case 0x14:
      if (command.size() > 1)
        self_test_error_ = false;
      else
        answer(code, 0, packed(std::array<std::uint32_t, 9>{self_test_error_ ? 4U : 0U}), "0");
      return;
    case 0x15:
      if (const std::size_t comma = command.find(','); comma != std::string::npos)
        settings_.active = static_cast<std::uint32_t>(std::stoul(command.substr(comma + 1), nullptr, 16));
      else
        answer(code, 0, packed(std::array{station_map()}), fmt::format("{:08X}", station_map()));
      return;
    case 0x16: {
      const std::string text =
          "Polhemus LIBERTY HST\r\n8 Stations\r\n\r\nSystem Controller Version:  2.0.1\r\n";
      const std::string head("\x08\x00\x00", 3);
      const Bytes body = bytes_from(head + text);
      return answer(code, 0, body, text);
    }
    default:
      return refuse_with(code, 0x01, "Invalid Command\r\n");
  }
}

std::uint32_t FakeLiberty::station_map() const {
  std::uint32_t detected = 0;
  for (std::size_t i = 0; i < sensors_.size(); ++i)
    if (sensors_[i].plugged) detected |= 1U << i;
  return settings_.active | (detected << 16);
}

void FakeLiberty::answer(std::uint8_t command, int station, const Bytes& body, const std::string& text) {
  if (dumb_) return;
  if (settings_.binary) return send(frame(station, command, 0, body));
  const std::string line =
      fmt::format("{:02}{} {}\r\n", station, static_cast<char>(std::tolower(command)), text);
  send({line.begin(), line.end()});
}

void FakeLiberty::refuse_with(std::uint8_t command, std::uint8_t error, const std::string& text) {
  if (dumb_) return;
  const Bytes body(text.begin(), text.end());
  send(settings_.binary ? frame(0, command, error, body) : body);
}

// --- output

}  // namespace linescope::testing
