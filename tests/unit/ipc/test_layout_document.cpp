// docs/segment.md and the C headers say the same: every member, every offset, every size, in both directions.
// What the headers say is proven by the compiler (segment_layout_check.h), and that nothing is forgotten
// there is tested here.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "ipc/control_layout.h"

namespace linescope::testing {
namespace {

using Offsets = std::map<std::string, std::uint64_t>;  // "ls_header.magic" -> 0

std::string contents(const std::string& file) {
  std::ifstream in(std::filesystem::path(LINESCOPE_SOURCE_DIR) / file);
  std::stringstream text;
  text << in.rdbuf();
  EXPECT_FALSE(text.str().empty()) << file;
  return text.str();
}

template <class Use>
void each_match(const std::string& text, const std::string& pattern, const Use& use) {
  const std::regex regex(pattern);
  for (std::sregex_iterator i(text.begin(), text.end(), regex), end; i != end; ++i) use(*i);
}

std::string all_headers() {
  return contents("ipc/segment_layout.h") + contents("ipc/segment_layout_check.h") +
         contents("ipc/control_layout.h");
}

std::string without_comments(std::string text) {
  for (std::size_t begin; (begin = text.find("/*")) != std::string::npos;)
    text.erase(begin, text.find("*/", begin) + 2 - begin);
  return text;
}

Offsets asserted_offsets() {
  Offsets found;
  each_match(all_headers(), R"(LS_ASSERT_AT\((\w+), (\w+), (\d+)\);)",
             [&](const std::smatch& m) { found[m[1].str() + "." + m[2].str()] = std::stoull(m[3]); });
  return found;
}

Offsets asserted_sizes() {
  Offsets found;
  each_match(all_headers(), R"(LS_ASSERT_SIZE\((\w+), (\d+)\);)",
             [&](const std::smatch& m) { found[m[1]] = std::stoull(m[2]); });
  found["ls_control"] = sizeof(ls_control);  // written as a sum there
  return found;
}

TEST(LayoutDocument, EveryMemberOfEveryStructureIsAsserted) {
  const Offsets asserted = asserted_offsets();
  std::set<std::string> members;
  each_match(without_comments(all_headers()), R"(struct (ls_\w+) \{\n([^}]*)\n\};)",
             [&](const std::smatch& structure) {
               each_match(structure[2], R"( +(?:struct )?\w+ (\w+)(?:\[\w+\])?;)",
                          [&](const std::smatch& member) {
                            if (!member[1].str().starts_with("reserved"))
                              members.insert(structure[1].str() + "." + member[1].str());
                          });
             });
  EXPECT_GT(members.size(), 150U);
  for (const std::string& member : members)
    EXPECT_TRUE(asserted.contains(member)) << member << " has no LS_ASSERT_AT";
  for (const auto& [member, offset] : asserted)
    EXPECT_TRUE(members.contains(member)) << member << " is no member";
}

TEST(LayoutDocument, TheTablesHoldExactlyTheAssertedOffsets) {
  const std::string document = contents("docs/segment.md");
  Offsets documented, sizes;
  std::string structure;
  std::istringstream lines(document);
  for (std::string line; std::getline(lines, line);) {
    std::smatch m;
    if (std::regex_search(line, m, std::regex(R"(^### `(ls_\w+)` \((\d+) bytes\))"))) {
      structure = m[1];
      sizes[structure] = std::stoull(m[2]);
    } else if (std::regex_search(line, m, std::regex(R"(^\| (\d+) \| [\w\[\]]+ \| `(\w+)` \|)"))) {
      documented[structure + "." + m[2].str()] = std::stoull(m[1]);
    }
  }
  EXPECT_EQ(documented, asserted_offsets());
  EXPECT_EQ(sizes, asserted_sizes());
}

TEST(LayoutDocument, EveryNumberOfTheHeadersIsInTheDocument) {
  const std::string document = contents("docs/segment.md");
  each_match(contents("ipc/segment_layout.h"), R"(LS_SECTION_(\w+) = (\d+))", [&](const std::smatch& m) {
    std::string name = m[1];
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
    EXPECT_NE(document.find("| " + m[2].str() + " | " + name + " |"), std::string::npos) << name;
  });
}

}  // namespace
}  // namespace linescope::testing
