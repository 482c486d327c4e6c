// The command line: every mistake is one sentence.
#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "viewer/panel/operator_action.hpp"
#include "viewer/viewer_options.hpp"

namespace linescope {
namespace {

auto read(std::vector<const char*> words) {
  words.insert(words.begin(), "linescope-viewer");
  return read_viewer_options(static_cast<int>(words.size()), words.data());
}

TEST(ViewerOptions, DefaultsAreTheOneSidedSurfaceAndTheThesissInterval) {
  const auto read_back = read({});
  ASSERT_TRUE(read_back);
  const auto& o = std::get<ViewerOptions>(*read_back);
  EXPECT_EQ(o.mesher.method, MeshMethod::implicit);
  EXPECT_DOUBLE_EQ(o.mesher.interval, 1.27);
  EXPECT_EQ(o.feed.held_in, HeldIn::object);
  EXPECT_EQ(o.feed.segment, "linescope");
}

TEST(ViewerOptions, AreRead) {
  const auto read_back =
      read({"--segment", "x", "--mesher", "implicit", "--interval", "0.5", "--normal", "algorithm-1",
            "--hold-in", "world", "--size", "1920x1080", "--quit-after", "2"});
  ASSERT_TRUE(read_back) << read_back.error().message;
  const auto& o = std::get<ViewerOptions>(*read_back);
  EXPECT_EQ(o.feed.segment, "x");
  EXPECT_EQ(o.mesher.method, MeshMethod::implicit);
  EXPECT_EQ(o.normal, NormalChoice::algorithm_1);
  EXPECT_EQ(o.feed.held_in, HeldIn::world);
  EXPECT_EQ(o.width, 1920);
}

TEST(ViewerOptions, MistakesAreUsageErrorsThatNameTheOption) {
  const std::vector<std::pair<std::vector<const char*>, std::string>> wrong = {
      {{"--mesher", "magic"}, "--mesher"},
      {{"--interval", "-1"}, "interval"},
      {{"--size", "big"}, "--size"},
      {{"--size", "100x100"}, "960x600"},
      {{"--quit-after", "-3"}, "--quit-after"},
      {{"--font-scale", "9"}, "--font-scale"},
      {{"--segment", ""}, "--segment"},
      {{"--nonsense"}, "--nonsense"}};
  for (const auto& [words, expected] : wrong) {
    const auto read_back = read(words);
    ASSERT_FALSE(read_back) << words[0];
    EXPECT_EQ(read_back.error().exit, ExitCode::usage);
    EXPECT_NE(read_back.error().message.find(expected), std::string::npos) << read_back.error().message;
  }
}

TEST(OperatorActions, EveryOneHasItsOwnKeyAndName) {
  std::set<std::string> keys, names;
  for (const ActionInfo& i : operator_actions()) {
    EXPECT_TRUE(keys.insert(i.key).second) << i.key;
    EXPECT_TRUE(names.insert(i.id).second) << i.id;
    EXPECT_EQ(&info(i.action), &i);
    EXPECT_EQ(action_by_id(i.id), i.action);
  }
  EXPECT_FALSE(action_by_id("fly"));
  EXPECT_EQ(static_cast<std::size_t>(OperatorAction::quit) + 1, operator_actions().size());
}

}  // namespace
}  // namespace linescope
