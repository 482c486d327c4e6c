// A scripted Polhemus LIBERTY: commands in, packets out. It knows nothing of the driver under test; what it
// answers follows the unit's user manual as far as that is public. Shown to the driver over a direct line, a
// pseudo-terminal or umockdev's USB.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace linescope::testing {

/// What one sensor shows.
struct FakeSensor {
  bool plugged = false;
  std::uint8_t error = 0;  ///< error indicator of its records
  int distortion = 0;
};

/// Thread-safe: the test scripts it from one thread while the line serves it from another.
class FakeLiberty {
 public:
  explicit FakeLiberty(int sensors);

  // --- the line's side
  void receive(std::span<const std::uint8_t> bytes);
  /// The next packet, at most 512 bytes; nothing when none is due.
  std::optional<std::vector<std::uint8_t>> next_packet();

  // --- the world's side: what happens
  /// That many measuring cycles pass. They are sent when output is on, and are counted in any case.
  void run_cycles(int count);
  /// Cycles that were measured but never get out: the frame count goes on without them.
  void lose_cycles(int count);
  void plug(int station, bool plugged);
  void set_error(int station, std::uint8_t error);
  void set_distortion(int station, int level);
  /// Bytes that appear in the output from nowhere.
  void inject(std::span<const std::uint8_t> bytes);
  void inject(const std::string& bytes);
  /// The next packet loses this many bytes from its middle.
  void drop_bytes(int count);
  /// Packets no longer than this from now on (0: as long as they come), and cycles per packet before it is
  /// sent.
  void set_packets(std::size_t longest, int cycles_per_packet);
  /// Output off without a command, as by a stylus button.
  void go_quiet();
  /// Off and on again: defaults, no output, frame count from zero.
  void power_cycle();

  // --- the state somebody left it in
  void leave_streaming(bool binary);
  void leave_half_typed(const std::string& bytes);
  void leave_units_inches();
  void set_echo(bool on);
  /// It hears, but says nothing.
  void set_dumb(bool dumb);
  /// A setting that is not taken over: the command's first letter.
  void ignore(char command);
  /// A command that is refused with an error code.
  void refuse(char command, std::uint8_t error);
  void set_tag(std::array<char, 2> tag);
  /// Answers to the units question as text, as some firmware might.
  void set_self_test_error(bool on);

  // --- what can be asked
  std::vector<std::string> commands() const;  ///< readable, in order
  bool streaming() const;
  bool binary() const;
  std::uint32_t frame_count() const;
  std::uint64_t cycles_sent() const;
  std::size_t packets_waiting() const;
  std::uint64_t bytes_dropped_by_fifo() const;
  /// Position in centimetres and quaternion (w first) a station shows at a frame: closed form, for
  /// comparison.
  static std::array<float, 7> pose(int station, std::uint32_t frame);

 private:
  struct Settings {
    bool binary = false;
    bool centimetres = false;
    bool fifo = true;
    bool echo = false;
    int rate = 4;
    std::uint32_t active = 0xff;
    std::vector<int> items{2, 4, 1};
    std::array<float, 3> hemisphere{1, 0, 0};
    std::array<float, 4> position_filter{0.2F, 0.2F, 0.8F, 0.95F};
    std::array<float, 4> attitude_filter{0.2F, 0.2F, 0.8F, 0.95F};
  };
  using Bytes = std::vector<std::uint8_t>;

  void execute(const std::string& command);
  void execute_setting(char letter, const std::vector<double>& values, bool has_values);
  void execute_control(const std::string& command);
  void answer(std::uint8_t command, int station, const Bytes& body, const std::string& text);
  void refuse_with(std::uint8_t command, std::uint8_t error, const std::string& text);
  void make_cycle(std::uint8_t command);
  void append_binary(Bytes& out, int station, std::uint8_t command) const;
  void append_ascii(Bytes& out, int station) const;
  void send(const Bytes& bytes);
  void flush_cycle();
  Bytes frame(int station, std::uint8_t command, std::uint8_t error, const Bytes& body) const;
  std::uint32_t station_map() const;

  mutable std::mutex mutex_;
  Settings settings_;
  std::vector<FakeSensor> sensors_;
  bool streaming_ = false;
  bool dumb_ = false;
  bool self_test_error_ = false;
  std::string ignored_;
  std::array<std::uint8_t, 128> refused_{};
  std::array<char, 2> tag_{'L', 'Y'};
  std::string typed_;
  std::vector<std::string> commands_;
  std::deque<Bytes> packets_;
  Bytes collected_;
  int collected_cycles_ = 0;
  std::size_t longest_packet_ = 512;
  int cycles_per_packet_ = 1;
  int bytes_to_drop_ = 0;
  std::uint32_t frame_ = 0;
  std::uint64_t cycles_sent_ = 0;
  std::uint64_t fifo_dropped_ = 0;
};

}  // namespace linescope::testing
