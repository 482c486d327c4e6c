#include "acquire/tracker/liberty/start_up.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "acquire/tracker/liberty/commands.hpp"
#include "acquire/tracker/liberty/conversation.hpp"
#include "acquire/tracker/liberty/error_words.hpp"
#include "common/pose_sample.hpp"

namespace linescope {
namespace {

namespace cmd = liberty_command;

constexpr int kAttempts = 3;

class StartUp {
 public:
  StartUp(ByteTransport& transport, const LibertyOptions& options)
      : transport_(transport), options_(options), talk_(transport, options) {}

  Result<LibertyIdentity> run() {
    using Step = Result<void> (StartUp::*)();
    for (const Step step :
         {&StartUp::quieten, &StartUp::find_stations, &StartUp::introduce, &StartUp::configure,
          &StartUp::confirm_essentials, &StartUp::confirm_filters, &StartUp::go})
      if (auto done = (this->*step)(); !done) return tl::unexpected(done.error());
    return identity_;
  }

 private:
  tl::unexpected<Error> complain(ErrorCode code, std::string_view what) const {
    return fail(code, fmt::format("LIBERTY on {}: {}", transport_.description(), what));
  }

  Result<void> tell(std::initializer_list<std::string> commands) {
    for (const std::string& command : commands)
      if (auto told = talk_.tell(command); !told) return told;
    return {};
  }

  /// Whatever it was doing: end the half-typed command, stop, throw away what is under way; then binary.
  Result<void> quieten() {
    if (auto told = tell({cmd::end_line(), cmd::stop()}); !told) return told;
    if (auto drained = talk_.drain(); !drained) return drained;
    if (auto told = tell({cmd::echo_off(), cmd::binary()}); !told) return told;
    return talk_.drain();
  }

  Result<void> find_stations() {
    const auto reply = talk_.ask(cmd::ask_station_map(), cmd::kStationMap, kAttempts);
    if (!reply) return tl::unexpected(reply.error());
    if (!*reply) return nobody();
    return read_station_map(**reply);
  }

  Result<void> nobody() const {
    const auto tag = talk_.foreign_tag();
    if (tag == std::array{'P', 'A'})
      return complain(ErrorCode::unsupported, "this is a PATRIOT, not a LIBERTY");
    if (tag == std::array{'L', 'U'})
      return complain(ErrorCode::unsupported, "this is a LIBERTY LATUS, not a LIBERTY");
    return complain(ErrorCode::timeout, "it does not answer; " + transport_.silence_hint());
  }

  /// Low half active, high half detected (user manual, p. 55).
  Result<void> read_station_map(const Reply& reply) {
    if (is_error(reply.error) || reply.body.size() != 4)
      return complain(ErrorCode::invalid,
                      "its answer about the stations makes no sense; switch it off and on again");
    identity_.active = static_cast<std::uint16_t>(reply.body[0] | (reply.body[1] << 8));
    identity_.detected = static_cast<std::uint16_t>(reply.body[2] | (reply.body[3] << 8));
    return {};
  }

  Result<void> introduce() {
    const auto test = talk_.ask(cmd::ask_self_test(), cmd::kSelfTest, 1);
    if (!test) return tl::unexpected(test.error());
    if (*test) {
      const auto words = (*test)->whole_numbers();
      if (std::any_of(words.begin(), words.end(), [](long word) { return word != 0; })) {
        identity_.remarks.push_back(
            "its self-test reports errors; they were cleared and come back if they persist");
        if (auto told = tell({cmd::clear_self_test()}); !told) return told;
      }
    }
    const auto who = talk_.ask(cmd::ask_identity(), cmd::kIdentity, 1);
    if (!who) return tl::unexpected(who.error());
    if (*who) {
      const std::string text = (*who)->text();
      identity_.text = text.substr(std::min(text.find("Polhemus"), text.size()));
    }
    return {};
  }

  /// All of them, so that sensors can be plugged in later; on a serial line only those whose records fit for
  /// sure.
  std::uint8_t wanted_stations() const {
    if (options_.stations != 0) return options_.stations;
    const auto detected = static_cast<std::uint8_t>(identity_.detected & 0xff);
    return options_.port == LibertyPort::serial && detected != 0 ? detected : std::uint8_t{0xff};
  }

  Result<void> configure() {
    const std::uint16_t sensors = identity_.detected & wanted_stations();
    if (auto fits = check_line_capacity(options_, std::max(1, std::popcount(sensors))); !fits) return fits;
    return tell({cmd::stylus_as_marker(), cmd::reset_alignment(), cmd::reset_boresight(),
                 cmd::reset_source_mounting(), cmd::centimetres(), cmd::reset_tip_offsets(),
                 cmd::rate(options_.rate_hz), cmd::hemisphere(options_.hemisphere),
                 cmd::position_filter(options_.position_filter),
                 cmd::attitude_filter(options_.attitude_filter),
                 cmd::output(OutputList::for_options(options_)), cmd::fifo(options_.fifo),
                 cmd::set_station_map(wanted_stations())});
  }

  /// Units, rate, stations and output list: without these every number would mean something else.
  Result<void> confirm_essentials() {
    if (auto ok = confirm_number("units", cmd::ask_units(), 'U', 1); !ok) return ok;
    if (auto ok = confirm_number("rate", cmd::ask_rate(), 'R', options_.rate_hz == 120 ? 3 : 4); !ok)
      return ok;
    if (auto ok = find_stations(); !ok) return ok;
    if ((identity_.active & 0xff) != wanted_stations())
      return complain(ErrorCode::invalid, fmt::format("it enabled stations {:#04x} instead of {:#04x}; {}",
                                                      identity_.active, wanted_stations(), refused()));
    for (int station = 0; station < kMaxStations; ++station)
      if (((wanted_stations() & identity_.detected) >> station) & 1)
        if (auto ok = confirm_output(station); !ok) return ok;
    const auto refusals = talk_.refusals();
    if (!refusals.empty()) return complain(ErrorCode::invalid, "it refused " + refused());
    return {};
  }

  std::string refused() const {
    const auto list = talk_.refusals();
    return list.empty() ? "it gave no reason, switch it off and on again"
                        : fmt::format("{}", fmt::join(list, "; "));
  }

  Result<void> confirm_number(const char* what, const std::string& question, std::uint8_t code, long wanted) {
    const auto reply = talk_.ask(question, code, kAttempts);
    if (!reply) return tl::unexpected(reply.error());
    if (!*reply) return complain(ErrorCode::timeout, fmt::format("it does not say its {}", what));
    const auto numbers = (*reply)->whole_numbers();
    if (!numbers.empty() && numbers.front() == wanted && !is_error((*reply)->error)) return {};
    return complain(ErrorCode::invalid,
                    fmt::format("{} should be {} but is {}; {}", what, wanted,
                                numbers.empty() ? "unreadable" : std::to_string(numbers.front()), refused()));
  }

  Result<void> confirm_output(int station) {
    const OutputList wanted = OutputList::for_options(options_);
    const auto reply = talk_.ask(cmd::ask_output(station), 'O', kAttempts);
    if (!reply) return tl::unexpected(reply.error());
    if (!*reply) return complain(ErrorCode::timeout, "it does not say its output list");
    std::string found;
    for (const long item : (*reply)->whole_numbers()) {
      if (item < 0) break;
      found += fmt::format("{}{}", found.empty() ? "" : ",", item);
    }
    if (found == wanted.text()) return {};
    return complain(ErrorCode::invalid,
                    fmt::format("the output list of station {} should be {} but is {}; {}", station + 1,
                                wanted.text(), found, refused()));
  }

  Result<void> confirm_filters() {
    for (int station = 0; station < kMaxStations; ++station) {
      if (!(((wanted_stations() & identity_.detected) >> station) & 1)) continue;
      const Eigen::Vector3d h =
          options_.hemisphere.norm() > 0 ? options_.hemisphere.normalized() : options_.hemisphere;
      if (auto ok = confirm_reals(fmt::format("hemisphere of station {}", station + 1),
                                  cmd::ask_hemisphere(station), 'H', {h.x(), h.y(), h.z()});
          !ok)
        return ok;
    }
    if (auto ok =
            confirm_filter("position filter", cmd::ask_position_filter(), 'X', options_.position_filter);
        !ok)
      return ok;
    if (auto ok =
            confirm_filter("attitude filter", cmd::ask_attitude_filter(), 'Y', options_.attitude_filter);
        !ok)
      return ok;
    const auto fifo = talk_.ask(cmd::ask_fifo(), '@', 1);
    if (!fifo) return tl::unexpected(fifo.error());
    const auto number = *fifo ? (*fifo)->whole_numbers() : std::vector<long>{};
    if (number.empty() || is_error((*fifo)->error)) return remark("buffer mode");
    if (number.front() != (options_.fifo ? 1 : 0))
      return complain(ErrorCode::invalid, "the buffer mode was not taken over");
    return {};
  }

  Result<void> remark(const std::string& what) {
    identity_.remarks.push_back(fmt::format("it did not confirm the {}", what));
    return {};
  }

  /// The manual lists the filter's numbers in different orders for X and Y: compared as a set.
  Result<void> confirm_filter(const std::string& what, const std::string& question, std::uint8_t code,
                              const std::optional<LibertyFilter>& filter) {
    if (filter)
      return confirm_reals(what, question, code,
                           {filter->sensitivity, filter->low, filter->high, filter->factor});
    return confirm_reals(what, question, code, {0, 1, 0, 0});
  }

  Result<void> confirm_reals(const std::string& what, const std::string& question, std::uint8_t code,
                             std::vector<double> wanted) {
    const auto reply = talk_.ask(question, code, 1);
    if (!reply) return tl::unexpected(reply.error());
    if (!*reply || is_error((*reply)->error)) return remark(what);
    std::vector<double> found = (*reply)->reals();
    if (found.size() != wanted.size()) return remark(what);
    const std::string as_found = fmt::format("{:.3f}", fmt::join(found, ","));
    const std::string as_wanted = fmt::format("{:.3f}", fmt::join(wanted, ","));
    if (code != 'H') {
      std::sort(found.begin(), found.end());
      std::sort(wanted.begin(), wanted.end());
    }
    const bool same = std::equal(found.begin(), found.end(), wanted.begin(),
                                 [](double a, double b) { return std::abs(a - b) < 2e-3; });
    if (same) return {};
    return complain(ErrorCode::invalid,
                    fmt::format("the {} should be {} but is {}; {}", what, as_wanted, as_found, refused()));
  }

  Result<void> go() {
    if (options_.format == LibertyFormat::ascii)
      if (auto told = tell({cmd::ascii()}); !told) return told;
    return tell({cmd::reset_counters(), cmd::start_continuous()});
  }

  ByteTransport& transport_;
  const LibertyOptions& options_;
  Conversation talk_;
  LibertyIdentity identity_;
};

}  // namespace

Result<LibertyIdentity> start_liberty(ByteTransport& transport, const LibertyOptions& options) {
  return StartUp(transport, options).run();
}

void stop_liberty(ByteTransport& transport) {
  if (!transport.write(cmd::stop())) return;
  for (int i = 0; i < 100; ++i) {
    const auto chunk = transport.read(20 * kMillisecond);
    if (!chunk || chunk->bytes.empty()) return;
  }
}

}  // namespace linescope
