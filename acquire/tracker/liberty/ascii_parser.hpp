// A LIBERTY's text stream: one line per record, station (2 characters), error letter, then the numbers.
#pragma once

#include <array>

#include "acquire/tracker/liberty/liberty_record.hpp"
#include "acquire/tracker/liberty/output_list.hpp"

namespace linescope {

/// Numbers are taken by the blanks between them, so that their width does not matter; their count must be
/// that of the output list exactly. A line that is no pose record is handed on as an answer with command 0
/// when it is plain text
/// ("Invalid Command"), and counted as bad otherwise. Resynchronisation is the next line end.
class AsciiParser : public LibertyParser {
 public:
  explicit AsciiParser(const OutputList& list) : list_(list) {}

  void feed(std::span<const std::uint8_t> bytes, LibertySink& sink) override;
  void reset() override;
  const ParserCounters& counters() const override { return counters_; }

 private:
  void finish_line(LibertySink& sink);
  bool parse_pose(std::string_view line, LibertyReading& reading) const;
  void skip_line();

  OutputList list_;
  std::array<char, 512> line_;
  std::size_t filled_ = 0;
  bool overlong_ = false;
  bool in_rhythm_ = true;
  ParserCounters counters_;
};

}  // namespace linescope
