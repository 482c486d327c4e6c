// Brings a LIBERTY from whatever state it is in to continuous output as configured.
#pragma once

#include <string>
#include <vector>

#include "acquire/tracker/liberty/byte_transport.hpp"
#include "acquire/tracker/liberty/liberty_options.hpp"

namespace linescope {

/// What the unit said about itself.
struct LibertyIdentity {
  std::string text;                  ///< its own words (^V), one line
  std::uint16_t detected = 0;        ///< bit n: station n (0-based) has a sensor
  std::uint16_t active = 0;          ///< bit n: station n is enabled
  std::vector<std::string> remarks;  ///< self-test errors, settings the unit did not confirm
};

/// The unit may be streaming, in either format, in the middle of a command, with settings of somebody else,
/// or still in its self-test. Steps: stop and drain; binary; station map (proof that a LIBERTY listens; asked
/// three times); self-test; identity; alignment, boresight, mounting and tip offsets off; units, rate,
/// hemisphere, filters, output list, buffer, stations; every setting read back; counters to zero; continuous
/// output.
///
/// Failures: timeout (nobody answers; with the transport's hint), unsupported (another product's tag),
/// invalid (does not fit the line; a setting was refused, or reads back differently: named with both values),
/// gone. Units, rate and output list must be confirmed; another setting the unit will not read back becomes a
/// remark.
Result<LibertyIdentity> start_liberty(ByteTransport& transport, const LibertyOptions& options);

/// Ends continuous output and waits for silence, so that the next start finds a quiet unit.
void stop_liberty(ByteTransport& transport);

}  // namespace linescope
