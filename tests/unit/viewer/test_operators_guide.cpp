// The guide's table of keys is the program's.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "viewer/panel/operator_action.hpp"

namespace linescope {
namespace {

TEST(OperatorsGuide, HasEveryActionWithItsKey) {
  std::ifstream file(LINESCOPE_SOURCE_DIR "/docs/operators-guide.md");
  ASSERT_TRUE(file);
  std::stringstream text;
  text << file.rdbuf();
  const std::string guide = text.str();
  for (const ActionInfo& i : operator_actions()) {
    const std::string row = fmt::format("| `{}` | {} | `{}` |", i.key, i.text, i.id);
    EXPECT_NE(guide.find(row), std::string::npos) << "docs/operators-guide.md lacks the row\n" << row;
  }
}

}  // namespace
}  // namespace linescope
