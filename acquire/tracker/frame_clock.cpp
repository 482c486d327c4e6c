#include "acquire/tracker/frame_clock.hpp"

#include <algorithm>
#include <cmath>

namespace linescope {
namespace {

constexpr double kLeastSigma =
    20'000;                       // ns; below this the scheduler's own grain would be mistaken for outliers
constexpr double kTukey = 4.685;  // 95 % efficiency on clean data
constexpr double kMadToSigma = 1.4826;

/// Median of the first `count` values, which are reordered.
template <std::size_t N>
double median(std::array<double, N>& values, int count) {
  if (count == 0) return 0;
  const auto middle = values.begin() + count / 2;
  std::nth_element(values.begin(), middle, values.begin() + count);
  return *middle;
}

double tukey_weight(double residual, double sigma) {
  const double u = residual / (kTukey * sigma);
  if (std::abs(u) >= 1) return 0;
  return (1 - u * u) * (1 - u * u);
}

}  // namespace

Result<void> validate(const FrameClockOptions& options) {
  if (!(options.nominal_hz >= 10 && options.nominal_hz <= 10'000))
    return fail(ErrorCode::invalid, "tracker clock: nominal_hz must lie between 10 and 10000");
  if (options.latency < 0 || options.latency > kSecond)
    return fail(ErrorCode::invalid, "tracker clock: latency must lie between 0 and 1 s");
  return {};
}

FrameClock::FrameClock(const FrameClockOptions& options)
    : options_(options),
      period_(1e9 / options.nominal_hz),
      block_frames_(std::max<std::int64_t>(1, std::llround(options.nominal_hz / 10))) {}

void FrameClock::reset() {
  *this = FrameClock(options_);
}

void FrameClock::observe(std::int64_t frame, Nanoseconds arrival) {
  if (!running_) {
    running_ = true;
    first_frame_ = frame;
    first_arrival_ = arrival;
  }
  const auto relative = static_cast<double>(frame - first_frame_);
  const double late = static_cast<double>(arrival - first_arrival_) - relative * period_;
  const std::int64_t number = (frame - first_frame_) / block_frames_;
  if (number != block_number_) close_block();
  block_number_ = number;
  if (current_.count == 0 || late < current_.least) {
    current_.frame = relative;
    current_.least = late;
  }
  current_.most = current_.count == 0 ? late : std::max(current_.most, late);
  current_.sum += late;
  ++current_.count;
  // Until there is a fit, the least late arrival so far is the best guess.
  if (used_ < 3) offset_ = std::min(offset_, late);
}

void FrameClock::close_block() {
  if (current_.count == 0) return;
  blocks_[static_cast<std::size_t>(next_)] = current_;
  next_ = (next_ + 1) % kBlocks;
  used_ = std::min(used_ + 1, kBlocks);
  current_ = {};
  if (used_ >= 3) refit();
}

void FrameClock::refit() {
  fit_offset();
  for (int iteration = 0; iteration < 5; ++iteration) {
    std::array<double, kBlocks> spread;
    for (int i = 0; i < used_; ++i)
      spread[static_cast<std::size_t>(i)] = std::abs(residual(blocks_[static_cast<std::size_t>(i)]));
    sigma_ = std::max(kLeastSigma, kMadToSigma * median(spread, used_));
    fit_line();
  }
}

/// Start of the iteration: the slope found last, through the median.
void FrameClock::fit_offset() {
  std::array<double, kBlocks> values;
  for (int i = 0; i < used_; ++i) {
    const Block& block = blocks_[static_cast<std::size_t>(i)];
    values[static_cast<std::size_t>(i)] = block.least - slope_ * block.frame;
  }
  offset_ = median(values, used_);
}

void FrameClock::fit_line() {
  double w = 0, wx = 0, wy = 0;
  std::array<double, kBlocks> weights;
  for (int i = 0; i < used_; ++i) {
    const Block& block = blocks_[static_cast<std::size_t>(i)];
    const double weight = tukey_weight(residual(block), sigma_);
    weights[static_cast<std::size_t>(i)] = weight;
    w += weight;
    wx += weight * block.frame;
    wy += weight * block.least;
  }
  if (!(w > 0)) return;
  const double mean_x = wx / w;
  const double mean_y = wy / w;
  if (used_ >= kBlocksForRate) {
    double xx = 0, xy = 0;
    for (int i = 0; i < used_; ++i) {
      const Block& block = blocks_[static_cast<std::size_t>(i)];
      const double dx = block.frame - mean_x;
      xx += weights[static_cast<std::size_t>(i)] * dx * dx;
      xy += weights[static_cast<std::size_t>(i)] * dx * (block.least - mean_y);
    }
    if (xx > 0) slope_ = xy / xx;
  }
  offset_ = mean_y - slope_ * mean_x;
}

Nanoseconds FrameClock::arrival_of(std::int64_t frame) const {
  const auto relative = static_cast<double>(frame - first_frame_);
  return first_arrival_ + static_cast<Nanoseconds>(std::llround(relative * period_ + line(relative)));
}

FrameClockFigures FrameClock::figures() const {
  FrameClockFigures figures;
  if (!running_) return figures;
  figures.rate_hz = 1e9 / (period_ + slope_);
  figures.blocks = used_;
  figures.fit_residual = static_cast<Nanoseconds>(sigma_);
  std::array<double, kBlocks> means;
  double worst = 0;
  for (int i = 0; i < used_; ++i) {
    const Block& block = blocks_[static_cast<std::size_t>(i)];
    means[static_cast<std::size_t>(i)] = block.sum / block.count - line(block.frame);
    worst = std::max(worst, block.most - line(block.frame));
  }
  figures.typical_lateness = static_cast<Nanoseconds>(median(means, used_));
  figures.worst_lateness = static_cast<Nanoseconds>(worst);
  return figures;
}

}  // namespace linescope
