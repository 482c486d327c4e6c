// What a function that can fail at run time returns: the value, or one clear sentence with a code for the
// program.
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace linescope {

enum class ErrorCode {
  usage,       ///< the command line or a call is wrong
  not_found,   ///< no such file, device, segment
  unreadable,  ///< it is there, but cannot be read as what it should be
  invalid,     ///< readable, but a value is impossible (range, unit, singular matrix, NaN)
  mismatch,    ///< two inputs do not belong together (picture size and calibration, layout versions)
  busy,        ///< somebody else holds it
  permission,  ///< the operating system refuses
  full,        ///< no room: memory, disk, segment
  timeout,     ///< no answer in time
  gone,        ///< it was there and is not any more (unplugged, dead, replaced)
  too_few,     ///< calibration: too few samples
  too_little_variation,  ///< calibration: samples too alike
  above_limit,           ///< calibration: error above the limit
  unsupported,           ///< known, but not offered
  internal,              ///< a promise of our own code is broken
};

/// A failure: `message` is one sentence for a person that says what, where and what to do.
struct Error {
  ErrorCode code = ErrorCode::internal;
  std::string message;
};

template <class T>
using Result = tl::expected<T, Error>;

/// `return fail(ErrorCode::not_found, fmt::format(...));`
inline tl::unexpected<Error> fail(ErrorCode code, std::string message) {
  return tl::unexpected<Error>(Error{code, std::move(message)});
}

}  // namespace linescope
