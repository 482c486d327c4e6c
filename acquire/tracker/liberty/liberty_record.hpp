// What comes out of a LIBERTY's byte stream.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <string_view>

namespace linescope {

/// One position-and-orientation record, units converted.
struct LibertyReading {
  std::uint8_t station = 0;  ///< 0-based
  std::uint8_t error = 0;    ///< error indicator as sent; see error_words.hpp
  bool has_pose = false;     ///< position and rotation are sane numbers
  std::uint32_t frame_count = 0;
  std::uint32_t timestamp_ms = 0;  ///< 0 when not asked for
  int distortion = -1;             ///< 0, 1, 2; -1 when not asked for
  int stylus = -1;                 ///< 0, 1; -1 when not asked for
  Eigen::Vector3d position_mm{0, 0, 0};
  Eigen::Quaterniond rotation{1, 0, 0, 0};
};

/// Any other frame: the answer to a query, or an error message. `body` is valid during the call only.
struct LibertyAnswer {
  std::uint8_t station = 0;  ///< as sent, 1-based; 0 when it concerns the whole unit
  std::uint8_t command = 0;  ///< the command it answers; 0 for a line of text
  std::uint8_t error = 0;
  std::span<const std::uint8_t> body;
};

/// Receives what a parser finds, in the order of the stream, during feed().
class LibertySink {
 public:
  virtual ~LibertySink() = default;
  virtual void on_reading(const LibertyReading& reading) = 0;
  virtual void on_answer(const LibertyAnswer& answer) = 0;
};

struct ParserCounters {
  std::uint64_t readings = 0;
  std::uint64_t answers = 0;
  std::uint64_t bad_records = 0;  ///< complete frames refused for their content
  std::uint64_t resyncs = 0;      ///< frames accepted behind bytes that had to be skipped
  std::uint64_t skipped_bytes = 0;
};

/// Bytes in, records out; any split of an undamaged stream into chunks gives the same records. Allocates
/// nothing.
class LibertyParser {
 public:
  virtual ~LibertyParser() = default;
  virtual void feed(std::span<const std::uint8_t> bytes, LibertySink& sink) = 0;
  virtual void reset() = 0;  ///< forgets half a record; counters stay
  virtual const ParserCounters& counters() const = 0;
};

/// The unit is always set to centimetres (U1).
inline constexpr double kMmPerUnit = 10;

/// A reading whose numbers cannot be a measurement is a sign of a damaged stream: not finite, further than 5
/// m away (the unit reaches 1.8 m), a quaternion off unit length, a flag that is none.
bool plausible(const LibertyReading& reading, double quaternion_length);

}  // namespace linescope
