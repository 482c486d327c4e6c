// A LIBERTY's binary stream: 8-byte header ('L','Y', station, command, error, reserved, body size), then the
// body.
#pragma once

#include <array>

#include "acquire/tracker/liberty/liberty_record.hpp"
#include "acquire/tracker/liberty/output_list.hpp"

namespace linescope {

/// What else than poses may be in the stream.
enum class Expecting : std::uint8_t {
  poses,    ///< continuous output: poses of exactly the listed size, and error messages in plain text
  answers,  ///< start-up: also answers of any kind and length
};

/// Resynchronisation. A pose record is accepted when its header is one (tag, station 1..16, command C or P,
/// known error, reserved 0, size exactly that of the output list) and its numbers are plausible. After any
/// skipped byte, and for a record whose error indicator excuses its numbers, the next record's tag (or the
/// end of what has arrived) must follow as well. Otherwise one byte is stepped over and the search goes on,
/// so nothing that is whole behind the damage is lost: the second whole record behind the last bad byte at
/// the latest is accepted.
class BinaryParser : public LibertyParser {
 public:
  BinaryParser(const OutputList& list, Expecting expecting);

  void feed(std::span<const std::uint8_t> bytes, LibertySink& sink) override;
  void reset() override;
  const ParserCounters& counters() const override { return counters_; }

  /// Tag of another Polhemus product seen where ours was expected ("PA", "LU"), or two zeros.
  std::array<char, 2> foreign_tag() const { return foreign_tag_; }

 private:
  enum class Verdict : std::uint8_t { reject, wait, accept };
  using Bytes = std::span<const std::uint8_t>;

  std::size_t scan(LibertySink& sink);
  Verdict examine(Bytes bytes, LibertySink& sink);
  Verdict examine_pose(Bytes bytes, LibertySink& sink);
  Verdict examine_answer(Bytes bytes, std::size_t size, LibertySink& sink);
  bool header_inside(Bytes bytes, std::size_t length) const;
  bool could_be_pose_header(Bytes bytes) const;
  bool next_tag_follows(Bytes bytes, std::size_t length) const;
  LibertyReading decode(Bytes record, double& quaternion_length) const;
  void skip_one(Bytes bytes);

  OutputList list_;
  Expecting expecting_;
  std::size_t body_size_;
  std::array<std::uint8_t, 8192> buffer_;
  std::size_t filled_ = 0;
  std::size_t accepted_length_ = 0;
  bool in_rhythm_ = true;
  std::array<char, 2> foreign_tag_{};
  ParserCounters counters_;
};

}  // namespace linescope
