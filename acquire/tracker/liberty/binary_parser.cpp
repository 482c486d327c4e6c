#include "acquire/tracker/liberty/binary_parser.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "acquire/tracker/liberty/error_words.hpp"

namespace linescope {
namespace {

static_assert(std::endian::native == std::endian::little, "the LIBERTY sends little endian numbers");

constexpr std::size_t kHeader = 8;
constexpr std::size_t kLongestAnswer = 1024;
constexpr std::size_t kLongestMessage = 128;

template <class T>
T load(std::span<const std::uint8_t> bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

bool printable(std::uint8_t c) {
  return (c >= ' ' && c <= '~') || c == '\r' || c == '\n' || c == '\t';
}

bool printable_text(std::span<const std::uint8_t> bytes) {
  return std::all_of(bytes.begin(), bytes.end(), printable);
}

}  // namespace

bool plausible(const LibertyReading& reading, double quaternion_length) {
  constexpr double kFarthest = 5000;  // mm
  return reading.position_mm.allFinite() && reading.position_mm.norm() <= kFarthest &&
         std::abs(quaternion_length - 1) <= 1e-3 && reading.distortion <= 2 && reading.distortion >= -1 &&
         reading.stylus <= 1 && reading.stylus >= -1;
}

BinaryParser::BinaryParser(const OutputList& list, Expecting expecting)
    : list_(list), expecting_(expecting), body_size_(list.body_size()) {}

void BinaryParser::reset() {
  filled_ = 0;
  in_rhythm_ = true;
}

void BinaryParser::feed(std::span<const std::uint8_t> bytes, LibertySink& sink) {
  while (!bytes.empty()) {
    const std::size_t count = std::min(bytes.size(), buffer_.size() - filled_);
    std::memcpy(buffer_.data() + filled_, bytes.data(), count);
    filled_ += count;
    bytes = bytes.subspan(count);
    const std::size_t done = scan(sink);
    std::memmove(buffer_.data(), buffer_.data() + done, filled_ - done);
    filled_ -= done;
  }
}

std::size_t BinaryParser::scan(LibertySink& sink) {
  std::size_t position = 0;
  while (position < filled_) {
    const Bytes rest(buffer_.data() + position, filled_ - position);
    const Verdict verdict = examine(rest, sink);
    if (verdict == Verdict::wait) break;
    if (verdict == Verdict::reject) {
      skip_one(rest);
      ++position;
      continue;
    }
    if (!in_rhythm_) ++counters_.resyncs;
    in_rhythm_ = true;
    position += accepted_length_;
  }
  return position;
}

void BinaryParser::skip_one(Bytes bytes) {
  in_rhythm_ = false;
  ++counters_.skipped_bytes;
  if (bytes.size() < 2) return;
  const std::array<char, 2> tag{static_cast<char>(bytes[0]), static_cast<char>(bytes[1])};
  if (tag == std::array{'P', 'A'} || tag == std::array{'L', 'U'}) foreign_tag_ = tag;
}

BinaryParser::Verdict BinaryParser::examine(Bytes bytes, LibertySink& sink) {
  if (bytes[0] != 'L') return Verdict::reject;
  if (bytes.size() > 1 && bytes[1] != 'Y') return Verdict::reject;
  if (bytes.size() < kHeader) return Verdict::wait;
  const auto size = load<std::int16_t>(bytes, 6);
  if (bytes[2] > 16 || bytes[5] != 0 || !known_error(bytes[4]) || size < 0) return Verdict::reject;
  const auto length = static_cast<std::size_t>(size);
  if (bytes[3] == 'C' || bytes[3] == 'P') {
    if (bytes[2] >= 1 && length == body_size_) return examine_pose(bytes, sink);
    if (!is_error(bytes[4])) return Verdict::reject;
  }
  return examine_answer(bytes, length, sink);
}

BinaryParser::Verdict BinaryParser::examine_pose(Bytes bytes, LibertySink& sink) {
  const std::size_t length = kHeader + body_size_;
  if (bytes.size() < length) return Verdict::wait;
  double quaternion_length = 0;
  LibertyReading reading = decode(bytes, quaternion_length);
  reading.has_pose = plausible(reading, quaternion_length) && !header_inside(bytes, length);
  const bool excused = state_for_error(reading.error) != ToolState::ok;
  const bool vouched = reading.has_pose && in_rhythm_;
  if (!vouched && !((reading.has_pose || excused) && next_tag_follows(bytes, length))) {
    if (!reading.has_pose) ++counters_.bad_records;
    return Verdict::reject;
  }
  ++counters_.readings;
  accepted_length_ = length;
  sink.on_reading(reading);
  return Verdict::accept;
}

BinaryParser::Verdict BinaryParser::examine_answer(Bytes bytes, std::size_t size, LibertySink& sink) {
  const std::size_t length = kHeader + size;
  const Bytes body = bytes.subspan(kHeader, std::min(size, bytes.size() - kHeader));
  if (expecting_ == Expecting::poses) {
    // Between poses only error messages are believed, and only as text: a false header cannot swallow records
    // then.
    if (!is_error(bytes[4]) || size > kLongestMessage || !printable_text(body)) return Verdict::reject;
  }
  if (size > kLongestAnswer) return Verdict::reject;
  if (bytes.size() < length) return Verdict::wait;
  if (!next_tag_follows(bytes, length)) return Verdict::reject;
  ++counters_.answers;
  accepted_length_ = length;
  sink.on_answer({bytes[2], bytes[3], bytes[4], body});
  return Verdict::accept;
}

bool BinaryParser::next_tag_follows(Bytes bytes, std::size_t length) const {
  const Bytes next = bytes.subspan(length);
  return (next.empty() || next[0] == 'L') && (next.size() < 2 || next[1] == 'Y');
}

/// A record that lost bytes runs on into the next one, whose header then lies inside of it.
bool BinaryParser::header_inside(Bytes bytes, std::size_t length) const {
  for (std::size_t i = 1; i < length; ++i)
    if (bytes[i] == 'L' && could_be_pose_header(bytes.subspan(i))) return true;
  return false;
}

/// Judged by the bytes that are there, three at least.
bool BinaryParser::could_be_pose_header(Bytes bytes) const {
  const std::size_t n = bytes.size();
  return n >= 3 && bytes[1] == 'Y' && bytes[2] >= 1 && bytes[2] <= 16 &&
         (n < 4 || bytes[3] == 'C' || bytes[3] == 'P') && (n < 5 || known_error(bytes[4])) &&
         (n < 6 || bytes[5] == 0) && (n < kHeader || load<std::uint16_t>(bytes, 6) == body_size_);
}

LibertyReading BinaryParser::decode(Bytes record, double& quaternion_length) const {
  LibertyReading reading;
  reading.station = static_cast<std::uint8_t>(record[2] - 1);
  reading.error = record[4];
  std::size_t at = kHeader;
  for (const OutputItem item : list_.items()) {
    switch (item) {
      case OutputItem::frame_count:
        reading.frame_count = load<std::uint32_t>(record, at);
        break;
      case OutputItem::timestamp:
        reading.timestamp_ms = load<std::uint32_t>(record, at);
        break;
      case OutputItem::distortion:
        reading.distortion = load<std::int32_t>(record, at);
        break;
      case OutputItem::stylus:
        reading.stylus = load<std::int32_t>(record, at);
        break;
      case OutputItem::position:
      case OutputItem::position_extended:
        reading.position_mm =
            kMmPerUnit * Eigen::Vector3d(load<float>(record, at), load<float>(record, at + 4),
                                         load<float>(record, at + 8));
        break;
      case OutputItem::quaternion:
        reading.rotation = Eigen::Quaterniond(load<float>(record, at), load<float>(record, at + 4),
                                              load<float>(record, at + 8), load<float>(record, at + 12));
        break;
      default:
        break;
    }
    at += binary_size(item);
  }
  quaternion_length = reading.rotation.norm();
  return reading;
}

}  // namespace linescope
