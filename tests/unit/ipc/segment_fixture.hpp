// A small segment of a name of its own for each test, and made-up lines whose every number tells where it
// came from.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <string>
#include <vector>

#include "ipc/segment_reader.hpp"
#include "ipc/segment_writer.hpp"

namespace linescope::testing {

/// Another name for every call and process, so that tests may run side by side.
inline std::string unique_segment_name() {
  static int number = 0;
  return "linescope-test-" + std::to_string(::getpid()) + "-" + std::to_string(number++);
}

inline SegmentOptions small_segment(const std::string& name) {
  SegmentOptions o;
  o.name = name;
  o.point_capacity = 2'000;
  o.line_capacity = 50;
  o.points_per_line = 200;
  o.pose_history = 16;
  o.picture_slots = 3;
  o.picture_bytes = 64 * 48 * 3;
  o.picture_samples = 32;
  o.frame_history = 16;
  o.text_bytes = 256;
  return o;
}

/// Points of line `seed`: position (seed, i, -i), intensity i, deviation seed.
inline std::vector<SurfacePoint> points_for(int seed, std::size_t count) {
  std::vector<SurfacePoint> points(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto f = static_cast<float>(i);
    points[i] = {{static_cast<float>(seed), f, -f}, f, static_cast<float>(seed)};
  }
  return points;
}

inline ScanLineInfo info_for(int seed) {
  ScanLineInfo info;
  info.time = kMillisecond * seed;
  info.frame = static_cast<std::uint64_t>(seed);
  info.endoscope = {{Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5), {1.0 * seed, 2, 3}}, ToolState::ok};
  info.object = {{Eigen::Quaterniond(1, 0, 0, 0), {4, 5.0 * seed, 6}}, ToolState::distorted_field};
  info.harvester = {{Eigen::Quaterniond(0, 1, 0, 0), {7, 8, 9.0 * seed}}, ToolState::missing};
  info.quality = {101, 2.5F, 12, 0.25F, 0.75F, 17, 4'000'000};
  return info;
}

inline void expect_points(std::span<const SurfacePoint> points, int seed, std::size_t count) {
  ASSERT_EQ(points.size(), count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto f = static_cast<float>(i);
    ASSERT_EQ(points[i].position, Eigen::Vector3f(static_cast<float>(seed), f, -f))
        << "point " << i << " of line " << seed;
    ASSERT_EQ(points[i].intensity, f);
    ASSERT_EQ(points[i].standard_deviation, static_cast<float>(seed));
  }
}

class SegmentTest : public ::testing::Test {
 protected:
  void SetUp() override { open(small_segment(name_)); }

  void open(const SegmentOptions& options) {
    writer_.reset();
    auto made = SegmentWriter::create(options);
    ASSERT_TRUE(made) << made.error().message;
    writer_ = std::make_unique<SegmentWriter>(std::move(*made));
    reader_ = std::make_unique<SegmentReader>(attach());
  }

  SegmentReader attach() const {
    auto attached = SegmentReader::attach({.name = name_});
    if (!attached) throw std::runtime_error(attached.error().message);
    return std::move(*attached);
  }

  PublishOutcome publish(int seed, std::size_t points) {
    return writer_->publish_line(info_for(seed), points_for(seed, points));
  }

  const std::string name_ = unique_segment_name();
  std::unique_ptr<SegmentWriter> writer_;
  std::unique_ptr<SegmentReader> reader_;
};

}  // namespace linescope::testing
