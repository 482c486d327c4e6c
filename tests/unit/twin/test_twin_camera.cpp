// The camera source: times, counters, end; and the truth as JSON.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "twin_fixture.hpp"

namespace linescope::twin {
namespace {

using testing::HasSubstr;

TEST(TwinCamera, ThirtyPicturesPerSecondStampedAtMidExposure) {
  TwinOptions options = ideal_twin();
  options.start = 5 * kSecond;
  options.instrument.latency = kMillisecond;
  const auto frames = pictures(options, 31);
  EXPECT_EQ(frames[0].time, 5 * kSecond + 4 * kMillisecond + kMillisecond);  // exposure 8 ms
  EXPECT_EQ(frames[30].time - frames[0].time, kSecond);
  EXPECT_EQ(frames[30].index, 30u);
  EXPECT_EQ(frames[0].bgr.type(), CV_8UC3);
  EXPECT_EQ(frames[0].bgr.cols, 360);
  EXPECT_EQ(frames[0].bgr.rows, 240);
}

TEST(TwinCamera, EndsAfterItsDurationAndStaysThere) {
  TwinOptions options = ideal_twin();
  options.duration = kSecond / 5;
  TwinCamera camera(experiment(options));
  Frame frame;
  EXPECT_EQ(camera.next(frame).error().code, ErrorCode::usage) << "not started";
  ASSERT_TRUE(camera.start());
  EXPECT_EQ(camera.status().state, CameraState::waiting);
  int count = 0;
  while (*camera.next(frame) == Pull::item) ++count;
  EXPECT_EQ(count, 6);
  EXPECT_EQ(camera.next(frame), Pull::end);
  EXPECT_EQ(camera.status().state, CameraState::ended);
  EXPECT_EQ(camera.status().counters.delivered, 6u);
  EXPECT_FALSE(camera.live());
  EXPECT_EQ(camera.period(), 33'333'333);
  EXPECT_THAT(camera.description(), HasSubstr("condyle"));
}

TEST(TwinCamera, MovesThePictureIntoTheCallersMemory) {
  TwinCamera camera(experiment(ideal_twin()));
  ASSERT_TRUE(camera.start());
  Frame frame;
  ASSERT_EQ(camera.next(frame), Pull::item);
  const auto* pixels = frame.bgr.data;
  ASSERT_EQ(camera.next(frame), Pull::item);
  EXPECT_EQ(frame.bgr.data, pixels);
}

TEST(TwinTruth, JsonHoldsPhantomSpotsAndPoses) {
  TwinOptions options = demo_twin();
  const std::string text = experiment(options)->truth().json(kSecond, 10);
  EXPECT_THAT(text, HasSubstr(R"("kind":"ellipsoid","semi_axes_mm":[25,22,25])"));
  EXPECT_THAT(text, HasSubstr(R"("spots":[{"position_mm":)"));
  EXPECT_THAT(text, HasSubstr(R"("time_ns":1000000000,"world_from_endoscope":)"));
  EXPECT_THAT(text, HasSubstr(R"("angle_to_normal_rad":null)"));
  EXPECT_EQ(std::count(text.begin(), text.end(), '{'), std::count(text.begin(), text.end(), '}'));
  std::size_t instants = 0;
  for (std::size_t at = text.find("time_ns"); at != std::string::npos; at = text.find("time_ns", at + 1))
    ++instants;
  EXPECT_EQ(instants, 11u);
}

}  // namespace
}  // namespace linescope::twin
