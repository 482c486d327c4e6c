// What can be chosen about a Polhemus LIBERTY. Plain data; the daemon fills it from its configuration file.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>

#include "common/result.hpp"
#include "common/time.hpp"

namespace linescope {

enum class LibertyPort : std::uint8_t { usb, serial };
enum class LibertyFormat : std::uint8_t {
  binary,  ///< the default: exact, compact
  ascii,   ///< for a unit or a line that only does text
};

/// The LIBERTY's adaptive filter (commands X and Y): low-pass between `low` and `high`, opening up with
/// speed.
struct LibertyFilter {
  double sensitivity = 0.2;  ///< F, 0 .. 1
  double low = 0.2;          ///< FLow, 0 .. 1, below high
  double high = 0.8;         ///< FHigh, 0 .. 1
  double factor = 0.95;      ///< Factor, 0 .. 1
};

struct LibertyOptions {
  LibertyPort port = LibertyPort::usb;
  std::string usb_path;  ///< bus and ports as in "1-2.3"; empty: the only LIBERTY there is
  std::string serial_device = "/dev/ttyUSB0";
  int baud = 115200;  ///< 38400, 57600 or 115200; must match the unit's setting

  LibertyFormat format = LibertyFormat::binary;
  int rate_hz = 240;                    ///< 240 or 120 cycles per second
  std::uint8_t stations = 0;            ///< bit n enables station n (0-based); 0: every station with a sensor
  Eigen::Vector3d hemisphere{1, 0, 0};  ///< half space the sensors stay in, as seen from the transmitter; the
                                        ///< zero vector turns on hemisphere tracking
  std::optional<LibertyFilter> position_filter;  ///< nothing: filter off (its lag is not calibrated)
  std::optional<LibertyFilter> attitude_filter;  ///< nothing: filter off
  bool ask_timestamp = true;   ///< 4 bytes per record each; a slow serial line may have to do without
  bool ask_distortion = true;  ///< without it metal near by goes unnoticed
  bool ask_stylus = true;
  bool fifo =
      true;  ///< true: the unit keeps 2300 bytes for a busy host; false: newest cycle only, losses are normal

  int distortion_limit =
      2;                   ///< 1 or 2: from this level of the distortion item on a pose is "distorted field"
  int missing_after = 24;  ///< cycles of the others without this station until its sensor counts as unplugged
  Nanoseconds device_latency =
      3'500 * kMicrosecond;              ///< middle of the measurement to result ready (user manual, E-1)
  Nanoseconds answer_timeout = kSecond;  ///< for one answer; asked three times
  Nanoseconds silence_limit = kSecond;   ///< listened to in vain for longer, a stream is started again
  Nanoseconds retry_after = 500 * kMillisecond;  ///< between attempts to find and start the unit
  bool required_at_start = true;  ///< start() fails when there is no working unit; false: it goes on looking
};

/// The first fault in one sentence. Includes the sum for a serial line: bytes per record x rate x stations
/// must fit.
Result<void> validate(const LibertyOptions& options);

/// Bytes per second of the stream with that many sensors.
double stream_bytes_per_second(const LibertyOptions& options, int stations);

/// What a serial line carries: ten bits per byte (8N1).
inline double serial_bytes_per_second(int baud) {
  return baud / 10.0;
}

/// Refuses a stream that does not fit into the serial line, with the sum and the ways out. USB always fits.
Result<void> check_line_capacity(const LibertyOptions& options, int stations);

}  // namespace linescope
