#include "acquire/twin/tracker_noise_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "acquire/twin/dice.hpp"
#include "common/euler.hpp"

namespace linescope::twin {
namespace {

constexpr int kWaves = 8;
constexpr std::uint64_t kStationSlots = 8;  // rows of random numbers per cycle, one per station

Eigen::Quaterniond small_rotation(const Eigen::Vector3d& vector) {
  const double angle = vector.norm();
  if (angle < 1e-15) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, vector / angle));
}

double on_grid(double value, double step) {
  return step > 0 ? std::round(value / step) * step : value;
}

Eigen::Vector3d quantised(const Eigen::Vector3d& position, double step) {
  return position.unaryExpr([step](double v) { return on_grid(v, step); });
}

// A LIBERTY sends angles; their grid is what limits the rotation.
Eigen::Quaterniond quantised(const Eigen::Quaterniond& rotation, double step) {
  if (!(step > 0)) return rotation;
  const EulerAngles angles = euler_from_quaternion(rotation);
  return quaternion_from_euler(
      {on_grid(angles.azimuth, step), on_grid(angles.elevation, step), on_grid(angles.roll, step)});
}

}  // namespace

SmoothField::SmoothField(std::uint64_t seed, std::uint64_t index, double rms, double smallest_wavelength_mm) {
  if (!(rms > 0)) return;
  Dice dice(seed, Stream::field, index);
  // Each wave has mean square amplitude^2 / 2, the waves add in squares.
  const double amplitude = rms * std::sqrt(2.0 / kWaves);
  for (int i = 0; i < kWaves; ++i) {
    const double wavelength = smallest_wavelength_mm * dice.uniform(1.0, 2.0);
    waves_.push_back({dice.direction() * amplitude, dice.direction() * (2 * std::numbers::pi / wavelength),
                      dice.uniform(0, 2 * std::numbers::pi)});
  }
}

Eigen::Vector3d SmoothField::at(const Eigen::Vector3d& place) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Wave& wave : waves_) sum += wave.amplitude * std::sin(wave.wave_vector.dot(place) + wave.phase);
  return sum;
}

TrackerNoiseModel::TrackerNoiseModel(std::uint64_t seed, const TrackerNoise& options)
    : seed_(seed),
      options_(options),
      position_field_(seed, 0, options.field_position_mm, options.field_wavelength_mm),
      rotation_field_(seed, 1, options.field_rotation_rad, options.field_wavelength_mm) {}

Rigid<World, Sensor> TrackerNoiseModel::reported(const Rigid<World, Sensor>& truth, int station,
                                                 std::uint64_t cycle) const {
  Dice dice(seed_, Stream::tracker, cycle * kStationSlots + static_cast<std::uint64_t>(station));
  const Eigen::Vector3d& place = truth.translation();
  const Eigen::Vector3d white = dice.normal3() * options_.position_sigma_mm;
  Eigen::Vector3d position = place + position_field_.at(place) + white;
  Eigen::Quaterniond rotation = small_rotation(rotation_field_.at(place)) * truth.rotation() *
                                small_rotation(dice.normal3() * options_.rotation_sigma_rad);
  // A dipole field looks the same from the opposite side: the device reports the side it was told.
  if (position.dot(options_.hemisphere) < 0) position = -position;
  return {quantised(rotation, options_.rotation_step_rad), quantised(position, options_.position_step_mm)};
}

double TrackerNoiseModel::true_seconds(std::uint64_t cycle) const {
  return static_cast<double>(cycle) / (options_.rate_hz * (1 + options_.clock_drift_ppm * 1e-6));
}

Nanoseconds TrackerNoiseModel::lateness(std::uint64_t cycle) const {
  if (!(options_.time_jitter_us > 0)) return options_.latency;
  Dice dice(seed_, Stream::tracker, ~cycle);
  // Cycles arrive in their order: the tail is cut at a third of the period.
  const double limit = 1e6 / options_.rate_hz / 3;
  const double late_us = std::min(std::abs(dice.normal()) * options_.time_jitter_us, limit);
  return options_.latency + static_cast<Nanoseconds>(std::llround(late_us * 1e3));
}

bool TrackerNoiseModel::dropped(int station, double seconds) const {
  if (!(options_.dropouts_per_second > 0)) return false;
  // One possible drop-out per slot of time, with a slot as long as two mean intervals at most.
  const double slot_seconds = std::max(4 * options_.dropout_seconds, 0.5);
  const double slot = std::floor(seconds / slot_seconds);
  Dice dice(seed_, Stream::dropout,
            static_cast<std::uint64_t>(slot) * kStationSlots + static_cast<std::uint64_t>(station));
  if (dice.uniform() >= options_.dropouts_per_second * slot_seconds) return false;
  const double length = options_.dropout_seconds * dice.uniform(0.5, 1.5);
  const double begin = dice.uniform(0, slot_seconds - length);
  const double inside = seconds - slot * slot_seconds;
  return inside >= begin && inside < begin + length;
}

}  // namespace linescope::twin
