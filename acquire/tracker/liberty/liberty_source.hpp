// A Polhemus LIBERTY as a tracker source (docs/liberty.md).
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "acquire/tracker/liberty/byte_transport.hpp"
#include "acquire/tracker/liberty/liberty_options.hpp"
#include "acquire/tracker/liberty/liberty_stream.hpp"
#include "acquire/tracker/liberty/start_up.hpp"
#include "acquire/tracker/sample_queue.hpp"
#include "acquire/tracker/tracker_ledger.hpp"

namespace linescope {

/// USB or serial, as the options say.
std::unique_ptr<ByteTransport> make_transport(const LibertyOptions& options);

/// Live. A thread of its own reads the device, so that its 25 ms of buffer never run over while the daemon is
/// busy.
///
///   searching -> starting -> streaming -> (silent: starting) (gone: searching)
///
/// Whatever happens after start(), it goes on by itself: a unit that falls silent is started again, one that
/// is unplugged is looked for until it is back. status().sentence says what it is doing and why.
class LibertySource : public TrackerSource, private SampleSink {
 public:
  explicit LibertySource(const LibertyOptions& options);
  /// With a transport of the caller's, for tests and other kinds of line.
  LibertySource(const LibertyOptions& options, std::unique_ptr<ByteTransport> transport);
  /// Stops the device's output, gives it back and ends the thread.
  ~LibertySource() override;

  Result<void> start() override;
  Result<Pull> next(PoseSample& out) override;
  bool live() const override { return true; }
  std::string description() const override;
  double nominal_hz() const override { return options_.rate_hz; }
  TrackerStatus status() const override { return ledger_.status(); }
  TrackerFigures figures() const override { return ledger_.figures(); }
  StationStatus station(int station) const override { return ledger_.station(station); }
  TrackerCounters counters() const override;

  void stop();

 private:
  void run();
  void find_unit();
  Result<void> start_unit();
  void read_stream();
  void handle_silence(Nanoseconds listened);
  void lose_unit(const Error& error);
  void say(bool delivering, std::string sentence);
  void hand_over();
  void publish();
  void publish_station(int station, StationStatus& status);

  void on_sample(const PoseSample& sample) override { fresh_.push_back(sample); }
  void on_message(std::uint8_t error, std::string_view text) override;

  LibertyOptions options_;
  std::unique_ptr<ByteTransport> transport_;
  LibertyStream stream_;
  LibertyIdentity identity_;
  std::vector<PoseSample> fresh_;  ///< of the current chunk; room for all of it from the start
  SampleQueue queue_{8192};        ///< 4 s of eight sensors
  TrackerLedger ledger_;
  std::thread thread_;
  std::atomic<bool> stopping_{false};
  bool streaming_ = false;  ///< the rest belongs to the thread while it runs
  int failed_restarts_ = 0;
  bool first_bytes_pending_ = false;  ///< started, but nothing came yet
  std::uint64_t starts_ = 0;          ///< that brought bytes
  Nanoseconds silent_for_ = 0;        ///< listened to in vain since the last bytes
  std::array<StationFigures, kMaxStations> published_;
};

}  // namespace linescope
