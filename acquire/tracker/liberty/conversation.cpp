#include "acquire/tracker/liberty/conversation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <cstring>

#include "acquire/tracker/liberty/commands.hpp"
#include "acquire/tracker/liberty/error_words.hpp"

namespace linescope {
namespace {

constexpr Nanoseconds kQuiet = 50 * kMillisecond;
constexpr Nanoseconds kLongestDrain = 2 * kSecond;

bool is_text(const std::vector<std::uint8_t>& body) {
  return !body.empty() && std::all_of(body.begin(), body.end(), [](std::uint8_t c) {
    return (c >= ' ' && c <= '~') || c == '\r' || c == '\n';
  });
}

/// Numbers of a text such as "00U 1" follow its first four characters.
std::vector<double> numbers_of_text(const std::string& text) {
  std::vector<double> numbers;
  const char* at = text.c_str() + std::min<std::size_t>(text.size(), 4);
  while (*at != '\0') {
    char* end = nullptr;
    const double number = std::strtod(at, &end);
    if (end == at)
      ++at;
    else {
      numbers.push_back(number);
      at = end;
    }
  }
  return numbers;
}

template <class T, class Out>
std::vector<Out> unpacked(const std::vector<std::uint8_t>& body) {
  std::vector<Out> numbers;
  for (std::size_t i = 0; i + sizeof(T) <= body.size(); i += sizeof(T)) {
    T value;
    std::memcpy(&value, body.data() + i, sizeof value);
    numbers.push_back(static_cast<Out>(value));
  }
  return numbers;
}

}  // namespace

std::string Reply::text() const {
  std::string text;
  for (const std::uint8_t c : body) {
    if (c >= ' ' && c <= '~')
      text += static_cast<char>(c);
    else if (!text.empty() && text.back() != ' ')
      text += ' ';
  }
  while (text.ends_with(' ')) text.pop_back();
  return text;
}

std::vector<long> Reply::whole_numbers() const {
  if (body.size() == 1 && !std::isdigit(body[0])) return {body[0]};
  if (is_text(body)) {
    const auto numbers = numbers_of_text(body.size() == 1 ? "    " + text() : text());
    return {numbers.begin(), numbers.end()};
  }
  if (body.size() == 2) return unpacked<std::int16_t, long>(body);
  return unpacked<std::int32_t, long>(body);
}

std::vector<double> Reply::reals() const {
  return is_text(body) ? numbers_of_text(text()) : unpacked<float, double>(body);
}

Conversation::Conversation(ByteTransport& transport, const LibertyOptions& options)
    : transport_(transport),
      timeout_(options.answer_timeout),
      parser_(OutputList::for_options(options), Expecting::answers) {}

Result<void> Conversation::drain() {
  const Nanoseconds give_up = monotonic_now() + kLongestDrain;
  for (int quiet = 0; quiet < 2;) {
    const auto chunk = transport_.read(kQuiet);
    if (!chunk) return tl::unexpected(chunk.error());
    quiet = chunk->bytes.empty() ? quiet + 1 : 0;
    parser_.feed(chunk->bytes, *this);
    if (monotonic_now() > give_up && quiet == 0)
      return fail(ErrorCode::timeout,
                  fmt::format("LIBERTY on {}: it goes on sending although told to stop; {}",
                              transport_.description(), transport_.silence_hint()));
  }
  parser_.reset();
  replies_.clear();
  return {};
}

Result<void> Conversation::tell(const std::string& command) {
  told_.push_back(command);
  return transport_.write(command);
}

void Conversation::on_answer(const LibertyAnswer& answer) {
  replies_.push_back({answer.command, answer.error, {answer.body.begin(), answer.body.end()}});
}

Result<bool> Conversation::wait_for(std::uint8_t code) {
  const Nanoseconds give_up = monotonic_now() + timeout_;
  for (;;) {
    for (const Reply& reply : replies_)
      if (reply.command == code) return true;
    const Nanoseconds left = give_up - monotonic_now();
    if (left <= 0) return false;
    const auto chunk = transport_.read(left);
    if (!chunk) return tl::unexpected(chunk.error());
    parser_.feed(chunk->bytes, *this);
  }
}

Result<std::optional<Reply>> Conversation::ask(const std::string& question, std::uint8_t code, int attempts) {
  std::erase_if(replies_,
                [code](const Reply& reply) { return reply.command == code && !is_error(reply.error); });
  for (int attempt = 0; attempt < attempts; ++attempt) {
    if (auto written = transport_.write(question); !written) return tl::unexpected(written.error());
    const auto answered = wait_for(code);
    if (!answered) return tl::unexpected(answered.error());
    if (!*answered) continue;
    const auto found = std::find_if(replies_.rbegin(), replies_.rend(),
                                    [code](const Reply& reply) { return reply.command == code; });
    return *found;
  }
  return std::nullopt;
}

std::vector<std::string> Conversation::refusals() const {
  std::vector<std::string> found;
  for (const Reply& reply : replies_) {
    if (!is_error(reply.error)) continue;
    const auto culprit = std::find_if(told_.rbegin(), told_.rend(), [&](const std::string& command) {
      return std::toupper(static_cast<unsigned char>(command[0])) == std::toupper(reply.command);
    });
    if (culprit == told_.rend()) continue;
    found.push_back(fmt::format("{}: {}", liberty_command::readable(*culprit), error_words(reply.error)));
  }
  return found;
}

}  // namespace linescope
