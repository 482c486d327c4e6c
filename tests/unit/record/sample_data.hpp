// Pictures, poses and a calibration with awkward bits, and comparisons that accept no difference.
#pragma once

#include <cstdint>
#include <cstring>
#include <limits>
#include <opencv2/core.hpp>

#include "acquire/camera/camera_source.hpp"
#include "acquire/record/recording_info.hpp"
#include "common/pose_sample.hpp"

namespace linescope::testing {

/// Different for every index: noise on a gradient.
inline Frame made_frame(std::uint64_t index, int width = 64, int height = 48) {
  Frame frame;
  frame.bgr.create(height, width, CV_8UC3);
  cv::RNG rng(index + 1);
  rng.fill(frame.bgr, cv::RNG::UNIFORM, 0, 40);
  for (int y = 0; y < height; ++y) frame.bgr.row(y) += cv::Scalar::all(y);
  frame.index = index;
  frame.time = 1'000'000'007 + static_cast<Nanoseconds>(index) * 33'333'333;
  frame.name = index % 2 == 0 ? "" : "im" + std::to_string(index) + ".png";
  return frame;
}

inline PoseSample made_sample(std::uint32_t count) {
  PoseSample sample;
  sample.time = 1'000'000'000 + static_cast<Nanoseconds>(count) * 4'166'667;
  sample.arrival = sample.time + 3'511'001;
  sample.frame_count = count;
  sample.station = static_cast<std::uint8_t>(count % 3);
  sample.state = count % 10 == 9 ? ToolState::out_of_view : ToolState::ok;
  const Eigen::Quaterniond rotation(0.1 + count, 0.2, -0.3 * count, 0.7);
  sample.world_from_sensor = {rotation, Eigen::Vector3d(1.0 / 3, -0.0, 1e-300 * count)};
  if (count % 4 == 0) sample.distortion = 0.1F * static_cast<float>(count);
  return sample;
}

inline Calibration made_calibration() {
  Calibration calibration = thesis_camera_ii();
  calibration.laser.normal = Eigen::Vector3d(0.01, 0.97, 0.24).normalized();
  calibration.laser.offset = 5.987654321012345;
  calibration.endoscope_from_camera = {Eigen::Quaterniond(0.5, 0.1, -0.2, 0.3), {1.0 / 7, 2, 30}};
  calibration.harvester.tip = {0.1, 0.2, 123.4567890123456789};
  calibration.camera_latency = 17'123'457;
  calibration.notes = {"first", "second"};
  return calibration;
}

inline RecordingInfo made_info() {
  RecordingInfo info;
  info.version = "0.1.0";
  info.camera = "a \"test\" camera";
  info.tracker = "a test tracker";
  info.configuration = "[camera]\nrate_hz = 30\n";
  info.calibration = made_calibration();
  info.camera_period = 33'333'333;
  return info;
}

template <class Number>
bool same_bits(Number a, Number b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

template <class To, class From>
bool same_bits(const Rigid<To, From>& a, const Rigid<To, From>& b) {
  return std::memcmp(a.rotation().coeffs().data(), b.rotation().coeffs().data(), 4 * sizeof(double)) == 0 &&
         std::memcmp(a.translation().data(), b.translation().data(), 3 * sizeof(double)) == 0;
}

inline bool same_bits(const PoseSample& a, const PoseSample& b) {
  return a.time == b.time && a.arrival == b.arrival && a.frame_count == b.frame_count &&
         a.station == b.station && a.state == b.state && same_bits(a.distortion, b.distortion) &&
         same_bits(a.world_from_sensor, b.world_from_sensor);
}

inline bool same_bits(const Frame& a, const Frame& b) {
  return a.time == b.time && a.index == b.index && a.name == b.name && a.bgr.size() == b.bgr.size() &&
         a.bgr.type() == b.bgr.type() && cv::norm(a.bgr, b.bgr, cv::NORM_INF) == 0;
}

}  // namespace linescope::testing
