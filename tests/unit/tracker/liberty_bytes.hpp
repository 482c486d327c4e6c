// LIBERTY records written byte by byte, independent of the code under test.
#pragma once

#include <array>
#include <cstring>
#include <string>
#include <vector>

#include "acquire/tracker/liberty/liberty_record.hpp"

namespace linescope::testing {

using Bytes = std::vector<std::uint8_t>;

inline Bytes bytes_of(const std::string& text) {
  return {text.begin(), text.end()};
}

inline void append(Bytes& out, const Bytes& more) {
  out.insert(out.end(), more.begin(), more.end());
}

template <class T>
void append_value(Bytes& out, T value) {
  std::array<std::uint8_t, sizeof(T)> raw;
  std::memcpy(raw.data(), &value, sizeof value);
  out.insert(out.end(), raw.begin(), raw.end());
}

/// Header and body; `station` as on the wire, from 1.
inline Bytes frame_bytes(int station, char command, std::uint8_t error, const Bytes& body) {
  Bytes out{'L', 'Y', static_cast<std::uint8_t>(station), static_cast<std::uint8_t>(command), error, 0};
  append_value(out, static_cast<std::int16_t>(body.size()));
  append(out, body);
  return out;
}

struct Wire {
  int station = 1;
  std::uint32_t frame = 0;
  std::uint8_t error = 0;
  std::int32_t distortion = 0;
  std::array<float, 3> position{1, 2, 3};
  std::array<float, 4> quaternion{1, 0, 0, 0};
};

/// The full default list: frame count, timestamp, distortion, stylus, position, quaternion. 52 bytes.
inline Bytes pose_bytes(const Wire& wire) {
  Bytes body;
  append_value(body, wire.frame);
  append_value(body, static_cast<std::uint32_t>(wire.frame * 1000ULL / 240));
  append_value(body, wire.distortion);
  append_value(body, std::int32_t{0});
  for (const float x : wire.position) append_value(body, x);
  for (const float x : wire.quaternion) append_value(body, x);
  return frame_bytes(wire.station, 'C', wire.error, body);
}

/// Keeps everything a parser says.
class Heard : public LibertySink {
 public:
  struct Answer {
    std::uint8_t station, command, error;
    std::string text;
  };
  void on_reading(const LibertyReading& reading) override { readings.push_back(reading); }
  void on_answer(const LibertyAnswer& a) override {
    answers.push_back({a.station, a.command, a.error, {a.body.begin(), a.body.end()}});
  }
  std::vector<LibertyReading> readings;
  std::vector<Answer> answers;
};

}  // namespace linescope::testing
