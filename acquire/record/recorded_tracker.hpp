// The tracker samples of a recording as a tracker.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "acquire/record/recorded_items.hpp"
#include "acquire/tracker/tracker_ledger.hpp"

namespace linescope {

/// Stepped. Gives the samples in the order in which they were recorded, with every bit. Damage is an error
/// `unreadable`, counted as bad_records, and the next call goes on behind it.
class RecordedTracker final : public TrackerSource {
 public:
  explicit RecordedTracker(std::filesystem::path folder);

  Result<void> start() override;
  Result<Pull> next(PoseSample& out) override;
  bool live() const override { return false; }
  std::string description() const override;
  TrackerStatus status() const override { return ledger_.status(); }
  StationStatus station(int station) const override { return ledger_.station(station); }
  TrackerCounters counters() const override { return ledger_.counters(); }

 private:
  tl::unexpected<Error> damaged(const Error& error);
  Pull finish();

  std::filesystem::path folder_;
  std::string tracker_;  ///< what the recording calls its tracker
  std::optional<RecordReader> reader_;
  Record record_;
  TrackerLedger ledger_;
};

}  // namespace linescope
