#include "acquire/tracker/liberty/commands.hpp"

#include <fmt/format.h>

namespace linescope::liberty_command {
namespace {

std::string line(std::string_view text) {
  return std::string(text) + '\r';
}

std::string control(char letter, std::string_view rest) {
  return std::string(1, static_cast<char>(letter - '@')) + line(rest);
}

std::string filter(char letter, const std::optional<LibertyFilter>& f) {
  if (!f) return line(fmt::format("{}0,1,0,0", letter));
  return line(
      fmt::format("{}{:.3f},{:.3f},{:.3f},{:.3f}", letter, f->sensitivity, f->low, f->high, f->factor));
}

}  // namespace

std::string end_line() {
  return "\r";
}
std::string stop() {
  return "P";
}
std::string start_continuous() {
  return line("C");
}
std::string binary() {
  return line("F1");
}
std::string ascii() {
  return line("F0");
}
std::string echo_off() {
  return control('E', "0");
}
std::string ask_station_map() {
  return control('U', "0");
}
std::string set_station_map(std::uint8_t stations) {
  return control('U', fmt::format("0,{:x}", stations));
}
std::string ask_self_test() {
  return control('T', "");
}
std::string clear_self_test() {
  return control('T', "0");
}
std::string ask_identity() {
  return control('V', "");
}
std::string stylus_as_marker() {
  return line("L*,0");
}
std::string reset_alignment() {
  return control('R', "*");
}
std::string reset_boresight() {
  return control('B', "*");
}
std::string reset_source_mounting() {
  return line("G0,0,0");
}
std::string reset_tip_offsets() {
  return line("N*,0,0,0");
}
std::string centimetres() {
  return line("U1");
}
std::string rate(int hz) {
  return line(hz == 120 ? "R3" : "R4");
}

std::string hemisphere(const Eigen::Vector3d& d) {
  const Eigen::Vector3d unit = d.norm() > 0 ? Eigen::Vector3d(d.normalized()) : d;
  return line(fmt::format("H*,{:.3f},{:.3f},{:.3f}", unit.x(), unit.y(), unit.z()));
}

std::string position_filter(const std::optional<LibertyFilter>& f) {
  return filter('X', f);
}
std::string attitude_filter(const std::optional<LibertyFilter>& f) {
  return filter('Y', f);
}
std::string output(const OutputList& list) {
  return line("O*," + list.text());
}
std::string fifo(bool on) {
  return line(on ? "@B1" : "@B0");
}
std::string reset_counters() {
  return line("Q0");
}

std::string ask_units() {
  return line("U");
}
std::string ask_rate() {
  return line("R");
}
std::string ask_hemisphere(int station) {
  return line(fmt::format("H{}", station + 1));
}
std::string ask_position_filter() {
  return line("X");
}
std::string ask_attitude_filter() {
  return line("Y");
}
std::string ask_output(int station) {
  return line(fmt::format("O{}", station + 1));
}
std::string ask_fifo() {
  return line("@B");
}

std::string readable(std::string_view command) {
  std::string text;
  for (const char c : command) {
    if (c == '\r') continue;
    if (c >= ' ')
      text += c;
    else
      text += {'^', static_cast<char>(c + '@')};
  }
  return text;
}

}  // namespace linescope::liberty_command
