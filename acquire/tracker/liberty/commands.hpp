// The commands we send to a LIBERTY. All are text, also in binary mode; all but P end with a carriage return.
#pragma once

#include <cstdint>
#include <string>

#include "acquire/tracker/liberty/liberty_options.hpp"
#include "acquire/tracker/liberty/output_list.hpp"

namespace linescope::liberty_command {

inline constexpr std::uint8_t kStationMap = 0x15;  ///< ^U: the command byte its answer carries
inline constexpr std::uint8_t kSelfTest = 0x14;    ///< ^T
inline constexpr std::uint8_t kIdentity = 0x16;    ///< ^V

std::string end_line();          ///< ends a half-typed command
std::string stop();              ///< P: one cycle, and the only way out of continuous output
std::string start_continuous();  ///< C
std::string binary();            ///< F1
std::string ascii();             ///< F0
std::string echo_off();          ///< ^E0
std::string ask_station_map();   ///< ^U0
std::string set_station_map(std::uint8_t stations);  ///< bit n: station n, 0-based
std::string ask_self_test();                         ///< ^T
std::string clear_self_test();                       ///< ^T0
std::string ask_identity();                          ///< ^V
std::string stylus_as_marker();                      ///< L*,0: the button must not stop the output
std::string reset_alignment();                       ///< ^R*
std::string reset_boresight();                       ///< ^B*
std::string reset_source_mounting();                 ///< G0,0,0
std::string reset_tip_offsets();                     ///< N*,0,0,0
std::string centimetres();                           ///< U1
std::string rate(int hz);                            ///< R3: 120, R4: 240
std::string hemisphere(const Eigen::Vector3d& direction);
std::string position_filter(const std::optional<LibertyFilter>& filter);  ///< X
std::string attitude_filter(const std::optional<LibertyFilter>& filter);  ///< Y
std::string output(const OutputList& list);                               ///< O*
std::string fifo(bool on);                                                ///< @B
std::string reset_counters();                                             ///< Q0

std::string ask_units();
std::string ask_rate();
std::string ask_hemisphere(int station);  ///< 0-based
std::string ask_position_filter();
std::string ask_attitude_filter();
std::string ask_output(int station);  ///< 0-based
std::string ask_fifo();

/// For logs and messages: control characters as ^X, the carriage return left out.
std::string readable(std::string_view command);

}  // namespace linescope::liberty_command
