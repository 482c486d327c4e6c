#include "acquire/tracker/liberty/liberty_options.hpp"

#include <fmt/format.h>

#include <bit>

#include "acquire/tracker/liberty/output_list.hpp"
#include "common/pose_sample.hpp"

namespace linescope {
namespace {

constexpr double kBinaryHeader = 8;
constexpr double kAsciiHeader = 4;
constexpr double kAsciiNumber = 9;    // Sxxx.xxxB and Sx.xxxxxB
constexpr double kAsciiCounter = 12;  // widest unsigned number with its blank

tl::unexpected<Error> wrong(std::string what) {
  return fail(ErrorCode::invalid, "LIBERTY: " + std::move(what));
}

double record_bytes(const LibertyOptions& options) {
  const OutputList list = OutputList::for_options(options);
  if (options.format == LibertyFormat::binary) return kBinaryHeader + static_cast<double>(list.body_size());
  double sum = kAsciiHeader;
  for (const OutputItem item : list.items()) {
    if (item == OutputItem::line_end)
      sum += 2;
    else
      sum += number_count(item) == 1 ? kAsciiCounter : kAsciiNumber * number_count(item);
  }
  return sum;
}

Result<void> check_filter(const std::optional<LibertyFilter>& filter, const char* which) {
  if (!filter) return {};
  for (const double value : {filter->sensitivity, filter->low, filter->high, filter->factor})
    if (!(value >= 0 && value <= 1))
      return wrong(
          fmt::format("a parameter of the {} filter is {}, it must lie between 0 and 1", which, value));
  if (!(filter->low < filter->high))
    return wrong(fmt::format("the {} filter's low is {} and its high {}, low must be smaller", which,
                             filter->low, filter->high));
  return {};
}

Result<void> check_times(const LibertyOptions& options) {
  if (options.device_latency < 0 || options.device_latency > kSecond)
    return wrong("device_latency must lie between 0 and 1 s");
  if (options.answer_timeout < kMillisecond || options.silence_limit < kMillisecond ||
      options.retry_after < 0)
    return wrong("answer_timeout and silence_limit must be at least 1 ms and retry_after not negative");
  return {};
}

Result<void> check_port(const LibertyOptions& options) {
  if (options.port == LibertyPort::usb) return {};
  if (options.serial_device.empty())
    return wrong("serial_device is empty, name one, for example /dev/ttyUSB0");
  if (options.baud != 38400 && options.baud != 57600 && options.baud != 115200)
    return wrong(fmt::format("baud is {}, a LIBERTY does 38400, 57600 and 115200", options.baud));
  return check_line_capacity(options, std::max(1, std::popcount(options.stations)));
}

}  // namespace

double stream_bytes_per_second(const LibertyOptions& options, int stations) {
  return record_bytes(options) * options.rate_hz * stations;
}

Result<void> check_line_capacity(const LibertyOptions& options, int stations) {
  if (options.port == LibertyPort::usb) return {};
  const double needed = stream_bytes_per_second(options, stations);
  const double offered = serial_bytes_per_second(options.baud);
  // A line that is full to the last byte never catches up after a pause: one in twenty is kept free.
  if (needed <= 0.95 * offered) return {};
  return wrong(
      fmt::format("{} bytes x {} Hz x {} sensor(s) = {} bytes/s, but {} baud carry {} bytes/s; use USB, 120 "
                  "Hz, fewer stations, or "
                  "leave out timestamp, stylus or distortion",
                  record_bytes(options), options.rate_hz, stations, needed, options.baud, offered));
}

Result<void> validate(const LibertyOptions& options) {
  if (options.rate_hz != 240 && options.rate_hz != 120)
    return wrong(fmt::format("rate_hz is {}, a LIBERTY does 120 and 240", options.rate_hz));
  if (!options.hemisphere.allFinite()) return wrong("hemisphere holds a number that is not finite");
  if (options.distortion_limit < 1 || options.distortion_limit > 2)
    return wrong(fmt::format("distortion_limit is {}, the unit's levels are 1 (minor) and 2 (significant)",
                             options.distortion_limit));
  if (options.missing_after < 2) return wrong("missing_after must be at least 2 cycles");
  if (auto checked = check_filter(options.position_filter, "position"); !checked) return checked;
  if (auto checked = check_filter(options.attitude_filter, "attitude"); !checked) return checked;
  if (auto checked = check_times(options); !checked) return checked;
  return check_port(options);
}

}  // namespace linescope
