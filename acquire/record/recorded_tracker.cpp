#include "acquire/record/recorded_tracker.hpp"

#include <fmt/format.h>

#include <utility>

#include "acquire/record/recording_info.hpp"

namespace linescope {

RecordedTracker::RecordedTracker(std::filesystem::path folder) : folder_(std::move(folder)) {}

Result<void> RecordedTracker::start() {
  const auto info = read_recording_info(folder_);
  if (!info) return tl::unexpected(info.error());
  auto reader = RecordReader::open(folder_ / kTrackerFile, RecordFileKind::tracker);
  if (!reader) return tl::unexpected(reader.error());
  tracker_ = info->info.tracker;
  reader_.emplace(std::move(*reader));
  ledger_.edit([this](TrackerLedger::Books& books) {
    books.status.delivering = true;
    books.status.sentence = fmt::format("replaying {}", folder_.string());
  });
  return {};
}

tl::unexpected<Error> RecordedTracker::damaged(const Error& error) {
  ledger_.edit([](TrackerLedger::Books& books) { ++books.counters.bad_records; });
  return tl::unexpected(error);
}

Result<Pull> RecordedTracker::next(PoseSample& out) {
  if (!reader_) return fail(ErrorCode::usage, "the recording was not started");
  for (;;) {
    auto pull = reader_->next(record_);
    if (!pull) return damaged(pull.error());
    if (*pull == Pull::end) return finish();
    if (record_.type != static_cast<std::uint32_t>(RecordType::sample)) continue;
    auto sample = read_sample(record_);
    if (!sample) return damaged(sample.error());
    out = *sample;
    ledger_.enter(out);
    return Pull::item;
  }
}

Pull RecordedTracker::finish() {
  const bool cut = reader_->unfinished_bytes() > 0;
  ledger_.edit([this, cut](TrackerLedger::Books& books) {
    books.status.delivering = false;
    books.status.sentence = fmt::format("recording {} is through{}", folder_.string(),
                                        cut ? "; it was cut off in the middle of a sample" : "");
  });
  return Pull::end;
}

std::string RecordedTracker::description() const {
  return tracker_.empty() ? fmt::format("recording {}", folder_.string())
                          : fmt::format("recording {} of {}", folder_.string(), tracker_);
}

}  // namespace linescope
