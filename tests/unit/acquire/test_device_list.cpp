#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "acquire/device_list.hpp"

namespace linescope {
namespace {

using ::testing::HasSubstr;
using Trackers = std::vector<TrackerFinding>;

TEST(DeviceList, SaysOfEachWhetherItCanBeUsedAndWhyNot) {
  const std::vector<CameraInfo> cameras{
      {"/dev/video0", "Endoscope", ""},
      {"/dev/video2", "Laptop", "/dev/video2 is in use by another program"}};
  const Trackers trackers{{"USB 1-2 (0f44:ff20)", "LIBERTY", {}},
                          {"USB 1-3 (0f44:ff21)", "LIBERTY without firmware",
                           Error{ErrorCode::not_found, "it waits for its firmware"}},
                          {"/dev/ttyUSB0", "serial line", {}}};
  EXPECT_EQ(
      list_text(cameras, trackers),
      "camera  /dev/video0  Endoscope  usable\n"
      "camera  /dev/video2  Laptop  /dev/video2 is in use by another program\n"
      "tracker USB 1-2 (0f44:ff20)  LIBERTY  usable\n"
      "tracker USB 1-3 (0f44:ff21)  LIBERTY without firmware  it waits for its firmware\n"
      "tracker /dev/ttyUSB0  serial line  free; whether a LIBERTY is at its end shows when it is started\n");
}

TEST(DeviceList, NothingThereIsSaidToo) {
  const std::string text = list_text({}, Trackers{});
  EXPECT_THAT(text, HasSubstr("camera  none: this machine has no /dev/video*"));
  EXPECT_THAT(text, HasSubstr("tracker none: no LIBERTY on USB"));
  EXPECT_THAT(list_text({}, fail(ErrorCode::unsupported, "USB cannot be used: no such device")),
              HasSubstr("tracker none: USB cannot be used: no such device"));
}

}  // namespace
}  // namespace linescope
