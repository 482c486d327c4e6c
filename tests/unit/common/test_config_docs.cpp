// The tables of docs/configuration.md are those of the declarations. To bring the page up to date:
//   LINESCOPE_UPDATE_DOCS=1 test_config_docs
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "acquire/acquire_options.hpp"

namespace linescope {
namespace {

const std::string kBegin =
    "<!-- keys: made from the declarations, see tests/unit/common/test_config_docs.cpp -->\n";
const std::string kEnd = "<!-- end of keys -->\n";

std::string text_of(const char* file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

std::string with_tables(const std::string& page, const std::string& tables) {
  const auto begin = page.find(kBegin), end = page.find(kEnd);
  if (begin == std::string::npos || end == std::string::npos) return "no markers in the page";
  return page.substr(0, begin + kBegin.size()) + '\n' + tables + '\n' + page.substr(end);
}

TEST(ConfigDocs, PageHasTheTablesOfTheDeclarations) {
  AcquireOptions options;
  ConfigSchema schema;
  declare(schema, options);
  EXPECT_THAT(schema.check(), ::testing::IsEmpty()) << schema.check().front().message;
  const std::string page = text_of(LINESCOPE_CONFIGURATION_PAGE);
  const std::string expected = with_tables(page, schema.to_markdown());
  if (std::getenv("LINESCOPE_UPDATE_DOCS") != nullptr)
    std::ofstream(LINESCOPE_CONFIGURATION_PAGE) << expected;
  EXPECT_EQ(page, expected) << "run it once with LINESCOPE_UPDATE_DOCS=1";
}

}  // namespace
}  // namespace linescope
