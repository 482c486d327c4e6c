#include "tools/calibrate/turn_correlation.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "acquire/tracker/pose_history.hpp"
#include "tools/calibrate/rotation_vector.hpp"

namespace linescope::calibrate {
namespace {

constexpr Nanoseconds kLongestGap = 50 * kMillisecond;
constexpr Nanoseconds kStep = 2 * kMillisecond;
constexpr Nanoseconds kSmoothing = 25 * kMillisecond;
constexpr std::ptrdiff_t kFewestSmoothed = 6;
constexpr double kUncovered = -2;  // below every correlation

bool earlier(const PoseSample& sample, Nanoseconds time) {
  return sample.time < time;
}

struct Sums {
  double n = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;
  void add(double a, double b) { n += 1, x += a, y += b, xx += a * a, yy += b * b, xy += a * b; }
  std::optional<double> pearson() const {
    const double vx = xx - x * x / n, vy = yy - y * y / n;
    if (!(vx > 0 && vy > 0)) return std::nullopt;
    return (xy - x * y / n) / std::sqrt(vx * vy);
  }
};

/// Top of the parabola through three equally spaced values, in steps from the middle one.
double parabola_top(double left, double middle, double right) {
  const double curvature = left - 2 * middle + right;
  return curvature < 0 ? 0.5 * (left - right) / curvature : 0;
}

}  // namespace

PoseTrack::PoseTrack(const std::vector<PoseSample>& samples) {
  for (const PoseSample& sample : samples) {
    const bool newer = good_.empty() || sample.time > good_.back().time;
    if (usable(sample.state) && newer) good_.push_back(sample);
  }
}

std::optional<Rigid<World, Sensor>> PoseTrack::at(Nanoseconds time) const {
  const auto after = std::lower_bound(good_.begin(), good_.end(), time, earlier);
  if (after == good_.end()) return std::nullopt;
  if (after->time == time) return after->world_from_sensor;
  if (after == good_.begin()) return std::nullopt;
  const PoseAnswer answer = pose_between(*(after - 1), *after, time, kLongestGap);
  if (!answer.ok()) return std::nullopt;
  return answer.world_from_sensor;
}

std::optional<Rigid<World, Sensor>> PoseTrack::smooth_at(Nanoseconds time) const {
  const auto plain = at(time);
  if (!plain) return plain;
  const auto first = std::lower_bound(good_.begin(), good_.end(), time - kSmoothing, earlier);
  const auto last = std::lower_bound(first, good_.end(), time + kSmoothing, earlier);
  if (last - first < kFewestSmoothed) return plain;
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Matrix<double, 3, 6> right = Eigen::Matrix<double, 3, 6>::Zero();
  for (auto sample = first; sample != last; ++sample) {
    const double u = static_cast<double>(sample->time - time) / static_cast<double>(kSmoothing);
    const double weight = (1 - u * u) * (1 - u * u);  // nothing jumps when a sample enters or leaves
    const Eigen::Vector3d powers(1, u, u * u);
    Eigen::Matrix<double, 6, 1> off;
    off << sample->world_from_sensor.translation() - plain->translation(),
        vector_from_quaternion(plain->rotation().conjugate() * sample->world_from_sensor.rotation());
    normal += weight * powers * powers.transpose();
    right += weight * powers * off.transpose();
  }
  const Eigen::Matrix<double, 1, 6> here = normal.ldlt().solve(right).row(0);
  return Rigid<World, Sensor>(plain->rotation() * quaternion_from_vector(here.tail<3>().transpose()),
                              plain->translation() + here.head<3>().transpose());
}

std::optional<double> correlation_at(const std::vector<TurnOver>& turns, const PoseTrack& track,
                                     Nanoseconds shift) {
  Sums sums;
  for (const TurnOver& turn : turns) {
    const auto from = track.at(turn.from - shift), to = track.at(turn.to - shift);
    if (!from || !to) continue;
    sums.add(turn.rate(),
             from->rotation().angularDistance(to->rotation()) / seconds_from(turn.to - turn.from));
  }
  if (!(sums.n > 0.9 * static_cast<double>(turns.size()))) return std::nullopt;
  return sums.pearson();
}

std::optional<CorrelationPeak> highest_correlation(const std::vector<TurnOver>& turns, const PoseTrack& track,
                                                   double range_ms) {
  std::vector<double> heights;
  const auto steps = static_cast<Nanoseconds>(range_ms * 1e6) / kStep;
  for (Nanoseconds i = -steps; i <= steps; ++i)
    heights.push_back(correlation_at(turns, track, i * kStep).value_or(kUncovered));
  const auto top = std::max_element(heights.begin(), heights.end());
  if (*top <= kUncovered) return std::nullopt;
  CorrelationPeak peak;
  peak.height = *top;
  peak.at_end =
      top == heights.begin() || top + 1 == heights.end() || top[-1] <= kUncovered || top[1] <= kUncovered;
  const double fraction = peak.at_end ? 0 : parabola_top(top[-1], top[0], top[1]);
  const auto place = static_cast<double>(top - heights.begin()) - static_cast<double>(steps);
  peak.shift_ms = (place + fraction) * static_cast<double>(kStep) * 1e-6;
  for (std::size_t i = 1; i + 1 < heights.size(); ++i) {
    const bool local = heights[i] >= heights[i - 1] && heights[i] >= heights[i + 1];
    if (local && heights.begin() + static_cast<std::ptrdiff_t>(i) != top)
      peak.rival = std::max(peak.rival, heights[i]);
  }
  return peak;
}

}  // namespace linescope::calibrate
