#include "acquire/tracker/timed_pose_source.hpp"

#include <fmt/format.h>

#include <cmath>

#include "acquire/tracker/timed_rows.hpp"

namespace linescope {

TimedPoseSource::TimedPoseSource(std::filesystem::path file, const TimedPoseOptions& options)
    : file_(std::move(file)), options_(options), last_of_station_(kMaxStations) {}

TimedPoseSource::~TimedPoseSource() = default;

Result<void> TimedPoseSource::start() {
  if (!(options_.mm_per_unit > 0) || !std::isfinite(options_.mm_per_unit))
    return fail(ErrorCode::usage, "recorded poses: mm_per_unit must be a positive number");
  auto rows = TimedRows::open(file_, options_.mm_per_unit);
  if (!rows) return tl::unexpected(rows.error());
  rows_ = std::move(*rows);
  pending_.clear();
  pending_.reserve(2);
  ledger_.edit([&](TrackerLedger::Books& books) { books.status = {{true, 0, 0}, description()}; });
  return {};
}

Result<Pull> TimedPoseSource::next(PoseSample& out) {
  if (!rows_) return fail(ErrorCode::usage, "recorded poses: next() was called before start()");
  while (handed_out_ == pending_.size()) {
    if (ended_) return Pull::end;
    pending_.clear();
    handed_out_ = 0;
    const auto more = read_row();
    if (!more) return tl::unexpected(more.error());
    if (!*more) ended_ = true;
  }
  out = pending_[handed_out_++];
  ledger_.enter(out);
  return Pull::item;
}

Result<bool> TimedPoseSource::read_row() {
  const auto more = rows_->next(pending_);
  if (!more) {
    pending_.clear();
    ledger_.edit([](TrackerLedger::Books& books) { ++books.counters.bad_records; });
    return more;
  }
  if (!*more) return false;
  if (auto order = check_order(pending_); !order) {
    pending_.clear();
    ended_ = true;
    ledger_.edit([&](TrackerLedger::Books& books) {
      ++books.counters.out_of_order;
      books.status = {{false, 0, 0}, order.error().message};
    });
    return tl::unexpected(order.error());
  }
  if (!shift_) shift_ = options_.first_row_at ? *options_.first_row_at - rows_->row_time() : 0;
  for (PoseSample& sample : pending_) {
    sample.time += *shift_;
    if (sample.arrival != 0) sample.arrival += *shift_;
  }
  return true;
}

Result<void> TimedPoseSource::check_order(const std::vector<PoseSample>& samples) {
  const Nanoseconds now = rows_->row_time();
  const auto refuse = [&](std::string_view than) {
    return fail(ErrorCode::invalid,
                fmt::format("{}: the row's time is {}; rows must be in time order, the rows before "
                            "this one were used, sort the file to use the rest",
                            rows_->reader().where(), than));
  };
  if (last_row_ && now < *last_row_) return refuse("earlier than the row before");
  last_row_ = now;
  for (const PoseSample& sample : samples) {
    auto& last = last_of_station_[sample.station];
    if (last && sample.time <= *last)
      return refuse(fmt::format("that of station {}'s last row", sample.station + 1));
    last = sample.time;
  }
  return {};
}

std::string TimedPoseSource::description() const {
  return fmt::format("recorded poses from {}", file_.string());
}

}  // namespace linescope
