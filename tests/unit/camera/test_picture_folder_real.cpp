#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "acquire/camera/picture_folder.hpp"
#include "tests/support/shared_data.hpp"

namespace linescope {
namespace {

TEST(FolderReal, MiniatureScannerComesInTheOrderOfItsPoseList) {
  LINESCOPE_NEEDS_SHARED_DATA();
  PictureFolder source({.folder = testing::shared_data("miniature-scanner/frames")});
  ASSERT_TRUE(source.start());
  std::ifstream poses(testing::shared_data("miniature-scanner/poses.csv"));
  std::string line;
  std::getline(poses, line);
  Frame frame;
  int count = 0;
  for (; std::getline(poses, line); ++count) {
    ASSERT_EQ(source.next(frame).value(), Pull::item);
    EXPECT_EQ(frame.name, line.substr(0, line.find(',')));
    EXPECT_EQ(frame.bgr.size(), cv::Size(640, 480));
  }
  EXPECT_EQ(count, 19);
  EXPECT_EQ(source.next(frame).value(), Pull::end);
}

}  // namespace
}  // namespace linescope
