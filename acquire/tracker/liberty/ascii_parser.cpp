#include "acquire/tracker/liberty/ascii_parser.hpp"

#include <algorithm>
#include <charconv>
#include <limits>
#include <optional>

#include "acquire/tracker/liberty/error_words.hpp"

namespace linescope {
namespace {

/// Takes blank-separated numbers off the front of a line.
class Numbers {
 public:
  explicit Numbers(std::string_view text) : text_(text) {}

  bool take(double& value) {
    skip_blanks();
    if (!text_.empty() && text_.front() == '+') text_.remove_prefix(1);
    const auto [end, error] = std::from_chars(text_.data(), text_.data() + text_.size(), value);
    if (error != std::errc()) return false;
    text_.remove_prefix(static_cast<std::size_t>(end - text_.data()));
    return text_.empty() || text_.front() == ' ';
  }

  template <class Integer>
  bool take_whole(Integer& value) {
    double number = 0;
    if (!take(number) || !(number >= 0) || number > static_cast<double>(std::numeric_limits<Integer>::max()))
      return false;
    value = static_cast<Integer>(number);
    return static_cast<double>(value) == number;
  }

  bool exhausted() {
    skip_blanks();
    return text_.empty();
  }

 private:
  void skip_blanks() { text_.remove_prefix(std::min(text_.find_first_not_of(' '), text_.size())); }

  std::string_view text_;
};

bool take_item(OutputItem item, Numbers& numbers, LibertyReading& reading) {
  switch (item) {
    case OutputItem::frame_count:
      return numbers.take_whole(reading.frame_count);
    case OutputItem::timestamp:
      return numbers.take_whole(reading.timestamp_ms);
    case OutputItem::distortion:
      return numbers.take_whole(reading.distortion);
    case OutputItem::stylus:
      return numbers.take_whole(reading.stylus);
    case OutputItem::position:
    case OutputItem::position_extended: {
      Eigen::Vector3d p;
      if (!numbers.take(p.x()) || !numbers.take(p.y()) || !numbers.take(p.z())) return false;
      reading.position_mm = kMmPerUnit * p;
      return true;
    }
    case OutputItem::quaternion: {
      Eigen::Quaterniond q;
      if (!numbers.take(q.w()) || !numbers.take(q.x()) || !numbers.take(q.y()) || !numbers.take(q.z()))
        return false;
      reading.rotation = q;
      return true;
    }
    default: {
      double ignored = 0;
      for (int i = 0; i < number_count(item); ++i)
        if (!numbers.take(ignored)) return false;
      return true;
    }
  }
}

std::optional<int> station_number(std::string_view line) {
  const auto digit = [](char c) { return c >= '0' && c <= '9'; };
  if (line.size() < 4 || !(digit(line[0]) || line[0] == ' ') || !digit(line[1])) return std::nullopt;
  const int number = (line[0] == ' ' ? 0 : line[0] - '0') * 10 + (line[1] - '0');
  return number >= 1 && number <= 16 ? std::optional(number) : std::nullopt;
}

bool plain_text(std::string_view line) {
  return std::all_of(line.begin(), line.end(), [](char c) { return c >= ' ' && c <= '~'; });
}

}  // namespace

void AsciiParser::reset() {
  filled_ = 0;
  overlong_ = false;
  in_rhythm_ = true;
}

void AsciiParser::feed(std::span<const std::uint8_t> bytes, LibertySink& sink) {
  for (const std::uint8_t byte : bytes) {
    if (byte == '\n') {
      finish_line(sink);
    } else if (filled_ < line_.size()) {
      line_[filled_++] = static_cast<char>(byte);
    } else {
      overlong_ = true;
      ++counters_.skipped_bytes;
    }
  }
}

void AsciiParser::skip_line() {
  ++counters_.bad_records;
  counters_.skipped_bytes += filled_;
  in_rhythm_ = false;
}

void AsciiParser::finish_line(LibertySink& sink) {
  std::string_view line(line_.data(), filled_);
  if (line.ends_with('\r')) line.remove_suffix(1);
  LibertyReading reading;
  if (overlong_) {
    skip_line();
  } else if (parse_pose(line, reading)) {
    ++counters_.readings;
    if (!in_rhythm_) ++counters_.resyncs;
    in_rhythm_ = true;
    sink.on_reading(reading);
  } else if (plain_text(line) && !station_number(line)) {
    if (!line.empty()) {
      ++counters_.answers;
      sink.on_answer({0, 0, 0, {reinterpret_cast<const std::uint8_t*>(line.data()), line.size()}});
    }
  } else {
    skip_line();
  }
  filled_ = 0;
  overlong_ = false;
}

bool AsciiParser::parse_pose(std::string_view line, LibertyReading& reading) const {
  const auto station = station_number(line);
  if (!station || !known_error(static_cast<std::uint8_t>(line[2]))) return false;
  reading.station = static_cast<std::uint8_t>(*station - 1);
  reading.error = line[2] == ' ' ? std::uint8_t{0} : static_cast<std::uint8_t>(line[2]);
  Numbers numbers(line.substr(3));
  for (const OutputItem item : list_.items())
    if (!take_item(item, numbers, reading)) return false;
  if (!numbers.exhausted()) return false;
  reading.has_pose = plausible(reading, reading.rotation.norm());
  return reading.has_pose || state_for_error(reading.error) != ToolState::ok;
}

}  // namespace linescope
