// What becomes of the points that are out of range, on the daemon's whole way from a picture to the segment.
#include <gtest/gtest.h>
#include <unistd.h>

#include <memory>
#include <stdexcept>
#include <string>

#include "acquire/line_pipeline.hpp"
#include "ipc/segment_reader.hpp"
#include "tests/unit/laser/line_scene.hpp"

namespace linescope {
namespace {

class LineCounters : public ::testing::Test {
 protected:
  LineCounters() {
    for (const Nanoseconds time : {kSecond, kSecond + 4 * kMillisecond}) {
      PoseSample s;
      s.time = time;
      s.state = ToolState::ok;
      history_.add(s);
    }
    SegmentOptions o;
    o.name = name_;
    o.point_capacity = 10'000;
    o.line_capacity = 50;
    o.points_per_line = 400;
    o.picture_bytes = 320 * 240 * 3;
    o.picture_samples = 400;
    auto made = SegmentWriter::create(o);
    if (!made) throw std::runtime_error(made.error().message);
    writer_ = std::make_unique<SegmentWriter>(std::move(*made));
    writer_->begin_scan(kSecond);
    writer_->set_scanning(true);
  }

  void pass(const cv::Mat& picture, const LineReconstructorOptions& range) {
    Calibration c = thesis_camera_ii();
    c.camera = c.camera.scaled_to(320, 240);
    c.camera.distortion = {};
    auto reconstructor = LineReconstructor::create(c, range);
    ASSERT_TRUE(reconstructor) << reconstructor.error().message;
    LinePipeline pipeline(LineExtractorOptions{}, *reconstructor, lookup_, *writer_);
    const Frame frame{picture, kSecond + kMillisecond, 0, "drawn"};
    pipeline.show(frame);
    pipeline.place(frame);
  }

  /// As a reader of the segment sees it.
  std::uint64_t counter(const std::string& name) const {
    auto reader = SegmentReader::attach({.name = name_});
    if (!reader) throw std::runtime_error(reader.error().message);
    for (const auto& c : reader->counters())
      if (c.name == name) return c.value;
    throw std::runtime_error("no counter " + name);
  }

  const std::string name_ = "linescope-counters-" + std::to_string(::getpid());
  PoseHistory history_;
  ToolPoseLookup lookup_{history_, StationRoles{}, 60 * kMillisecond};
  std::unique_ptr<SegmentWriter> writer_;
};

TEST_F(LineCounters, TooNearAndTooFarAreTwoReasons) {
  // A step with three levels: v = 119.2 - 305 (6 / z - 0.249) is row 20 at 10.4 mm, row 80 at 15.9 mm and row
  // 150 at 40.2 mm.
  testing::LineScene scene;
  scene.width = 320;
  scene.height = 240;
  const auto level = [](double v) { return [v](double) { return v; }; };
  scene.stripes = {{.centre = level(20), .first = 0, .last = 99},
                   {.centre = level(80), .first = 100, .last = 199},
                   {.centre = level(150), .first = 200, .last = 319}};
  LineReconstructorOptions range;
  range.min_depth_mm = 12;
  range.max_depth_mm = 30;
  pass(scene.draw(), range);
  EXPECT_EQ(counter("points_too_near"), 100U);
  EXPECT_EQ(counter("points_published"), 100U);
  EXPECT_EQ(counter("points_too_far"), 120U);
  EXPECT_EQ(counter("points_no_intersection"), 0U);
}

}  // namespace
}  // namespace linescope
