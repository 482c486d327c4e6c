// The way the bytes of a LIBERTY take: USB or a serial line.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "common/result.hpp"
#include "common/time.hpp"

namespace linescope {

/// Bytes that arrived together. Valid until the next call of the transport.
struct Chunk {
  std::span<const std::uint8_t> bytes;  ///< empty: nothing came in time
  Nanoseconds arrival = 0;              ///< of the last of them, CLOCK_MONOTONIC
};

/// One thread at a time. After a failure with code `gone` the transport is to be closed; open() may be tried
/// again.
class ByteTransport {
 public:
  virtual ~ByteTransport() = default;

  /// Finds the device and takes it for us alone. The failure says what is in the way and what to do:
  /// not_found (nothing there, or only the loader), permission, busy, unsupported (another product), usage
  /// (several).
  virtual Result<void> open() = 0;
  /// Gives it back. Harmless when not open.
  virtual void close() = 0;

  virtual Result<void> write(std::string_view bytes) = 0;
  /// Waits at most that long. Faults that only cost some bytes are repaired inside and counted.
  virtual Result<Chunk> read(Nanoseconds at_most) = 0;

  /// Sleeps at most that long, less when a device was plugged in or out meanwhile.
  virtual void wait_for_change(Nanoseconds at_most) = 0;

  /// "USB 1-2 (0f44:ff20)", "/dev/ttyUSB0 at 115200 baud"
  virtual std::string description() const = 0;
  /// What to say when the line is open but nobody answers.
  virtual std::string silence_hint() const = 0;
  /// Stalls, overflows, parity errors: repaired, but bytes may be lost.
  virtual std::uint64_t faults() const = 0;
};

}  // namespace linescope
