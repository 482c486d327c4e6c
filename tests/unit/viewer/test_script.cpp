#include <gtest/gtest.h>

#include "viewer/script.hpp"

namespace linescope {
namespace {

TEST(Script, ReadsStepsAndLeavesCommentsOut) {
  const auto steps =
      parse_script("# first\n\nwait 1.5  # a while\nscreenshot a.png\nwait-for points 100 20\n", "s");
  ASSERT_TRUE(steps) << steps.error().message;
  ASSERT_EQ(steps->size(), 3u);
  EXPECT_EQ((*steps)[0].verb, "wait");
  EXPECT_EQ((*steps)[0].number(0), 1.5);
  EXPECT_EQ((*steps)[0].line, 3);
  EXPECT_EQ((*steps)[2].words[0], "points");
}

TEST(Script, NamesTheLineOfTheFirstFault) {
  for (const char* bad : {"jump", "wait", "wait x", "wait nan", "camepos 1 2 3", "size 1 2 3"}) {
    const auto steps = parse_script("wait 1\n" + std::string(bad) + "\n", "demo.steps");
    ASSERT_FALSE(steps) << bad;
    EXPECT_EQ(steps.error().message.rfind("demo.steps:2: ", 0), 0u) << steps.error().message;
  }
}

TEST(Script, AMissingFileIsASentence) {
  const auto steps = load_script("/nowhere/at/all.steps");
  ASSERT_FALSE(steps);
  EXPECT_NE(steps.error().message.find("/nowhere/at/all.steps"), std::string::npos);
}

}  // namespace
}  // namespace linescope
