#include "acquire/tracker/frame_sequence.hpp"

namespace linescope {
namespace {

constexpr Nanoseconds kFutureSlack = 100 * kMillisecond;  // the fit is coarse in the first moments
constexpr std::int64_t kPastFrames = 240;                 // records of one cycle, or a cycle repeated
constexpr std::int64_t kSmallStep = 24;                   // forward: needs no proof by the clock
constexpr int kDoubtsForNewEpoch = 3;

}  // namespace

void FrameSequence::reset() {
  clock_.reset();
  started_ = false;
  doubts_ = 0;
}

bool FrameSequence::sensible(std::int64_t frame, Nanoseconds arrival) const {
  if (frame > newest_ + kSmallStep) return clock_.arrival_of(frame) <= arrival + kFutureSlack;
  return frame > newest_ - kPastFrames;
}

FrameSequence::Verdict FrameSequence::accept(std::uint32_t count, Nanoseconds arrival, std::int64_t& frame) {
  if (!started_) {
    started_ = true;
    newest_ = newest_ == 0 ? count : newest_ + 1;
    newest_count_ = count;
    clock_.observe(newest_, arrival);
    frame = newest_;
    return Verdict::new_epoch;
  }
  frame = newest_ + static_cast<std::int32_t>(count - newest_count_);
  if (!sensible(frame, arrival)) return doubt(count, arrival, frame);
  doubts_ = 0;
  if (frame > newest_) {
    newest_ = frame;
    newest_count_ = count;
    clock_.observe(frame, arrival);
  }
  return Verdict::believed;
}

FrameSequence::Verdict FrameSequence::doubt(std::uint32_t count, Nanoseconds arrival, std::int64_t& frame) {
  const std::uint32_t step = count - doubtful_count_;
  doubts_ = doubts_ > 0 && step <= static_cast<std::uint32_t>(kPastFrames) ? doubts_ + 1 : 1;
  doubtful_count_ = count;
  if (doubts_ < kDoubtsForNewEpoch) return Verdict::doubtful;
  reset();
  return accept(count, arrival, frame);
}

}  // namespace linescope
