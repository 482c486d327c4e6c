// Question and answer with a LIBERTY that is not streaming.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "acquire/tracker/liberty/binary_parser.hpp"
#include "acquire/tracker/liberty/byte_transport.hpp"

namespace linescope {

/// An answer, kept.
struct Reply {
  std::uint8_t command = 0;
  std::uint8_t error = 0;
  std::vector<std::uint8_t> body;

  /// The body as text without line ends.
  std::string text() const;
  /// Little-endian 32-bit whole numbers; a body of one or two bytes counts as one number; text is parsed.
  std::vector<long> whole_numbers() const;
  /// Little-endian floats, or the numbers of a text.
  std::vector<double> reals() const;
};

class Conversation : private LibertySink {
 public:
  Conversation(ByteTransport& transport, const LibertyOptions& options);

  /// Throws away what arrives until nothing came for two times 50 ms; timeout when it does not stop within
  /// two seconds.
  Result<void> drain();

  /// Sends a setting. It gives no answer; a refusal shows up in refusals() by the next question's answer.
  Result<void> tell(const std::string& command);

  /// Sends a question and waits for the answer that carries `code`, `attempts` times. An answer with an error
  /// code is an answer. Nothing when nobody answered.
  Result<std::optional<Reply>> ask(const std::string& question, std::uint8_t code, int attempts);

  /// Error answers to what was told, each as "O*,9,2,7: parameter above its limit".
  std::vector<std::string> refusals() const;
  std::array<char, 2> foreign_tag() const { return parser_.foreign_tag(); }

 private:
  void on_reading(const LibertyReading&) override {}
  void on_answer(const LibertyAnswer& answer) override;
  Result<bool> wait_for(std::uint8_t code);

  ByteTransport& transport_;
  Nanoseconds timeout_;
  BinaryParser parser_;
  std::vector<std::string> told_;
  std::vector<Reply> replies_;
};

}  // namespace linescope
