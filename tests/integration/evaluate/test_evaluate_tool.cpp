// linescope-evaluate as a person runs it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/child_process.hpp"
#include "tests/support/finished_run.hpp"

namespace linescope {
namespace {

using testing::file_contents;
using testing::Finished;
using ::testing::HasSubstr;
using testing::run_to_end;
using testing::TemporaryFolder;

constexpr std::chrono::seconds kPatience(200);

Finished evaluate(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), LINESCOPE_EVALUATE);
  return run_to_end(std::move(arguments), kPatience);
}

TEST(EvaluateTool, SameSeedsSameBytesHoweverManyJobs) {
  const std::vector<std::string> base{"--quick", "--seeds", "2", "--only", "noise-free,site,prism", "--json"};
  auto one = base, two = base;
  one.insert(one.end(), {"--jobs", "1"});
  two.insert(two.end(), {"--jobs", "2"});
  const Finished first = evaluate(one), second = evaluate(two);
  ASSERT_EQ(first.code, 0) << first.err;
  EXPECT_GT(first.out.size(), 2000u);
  EXPECT_EQ(first.out, second.out);
}

TEST(EvaluateTool, WritesTextAndHtmlWithDrawings) {
  const TemporaryFolder folder;
  const auto html = folder.path() / "report.html";
  const Finished o = evaluate({"--quick", "--seeds", "1", "--only", "site,prism", "--html", html.string()});
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_THAT(o.out, HasSubstr("SIMULATED"));
  EXPECT_THAT(o.out, HasSubstr("Table 3.3"));
  const std::string page = file_contents(html);
  EXPECT_THAT(page, HasSubstr("<figure id=\"error-map\"><svg"));
  EXPECT_THAT(page, HasSubstr("Not for clinical use"));
}

TEST(EvaluateTool, RefusesInOneSentence) {
  EXPECT_EQ(evaluate({"--only", "nonsense"}).code, 2);
  EXPECT_EQ(evaluate({"--shape", "plane"}).code, 2) << "a shape belongs to a recording";
  const Finished missing = evaluate({"--replay", "/no/such/recording"});
  EXPECT_EQ(missing.code, 1);
  EXPECT_THAT(missing.err, HasSubstr("/no/such/recording"));
  const Finished unwritable = evaluate({"--only", "prism", "--html", "/no/such/folder/report.html"});
  EXPECT_EQ(unwritable.code, 1);
  EXPECT_THAT(unwritable.err, HasSubstr("/no/such/folder/report.html"));
}

TEST(EvaluateTool, JudgesARecordedSessionByItsShape) {
  const TemporaryFolder folder;
  const std::string recording = (folder.path() / "session").string();
  const Finished recorded =
      run_to_end({LINESCOPE_ACQUIRE, "--segment", testing::unique_segment(), "--fast", "--scan",
                  "--exit-at-end", "--record", recording, "--set", "twin.phantom=cylinder-50", "--set",
                  "twin.scenario=sweeps", "--set", "twin.noise=ideal", "--set", "twin.duration_s=2.5"},
                 kPatience);
  ASSERT_EQ(recorded.code, 0) << recorded.err;
  const Finished o = evaluate({"--replay", recording, "--shape", "cylinder-50", "--json"});
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_THAT(o.out, HasSubstr("recorded session"));
  EXPECT_THAT(o.out, ::testing::Not(HasSubstr("SIMULATED")));
  // Without noise the diameter comes back to a few hundredths: "bias of the diameter (50 mm), points".
  const auto row = o.out.find("bias of the diameter (50 mm), points");
  ASSERT_NE(row, std::string::npos) << o.out;
  const auto mean = o.out.find("\"mean\":", row);
  EXPECT_NEAR(std::stod(o.out.substr(mean + 7)), 0, 0.05);
  EXPECT_EQ(evaluate({"--replay", recording, "--shape", "sphere"}).code, 2);
}

}  // namespace
}  // namespace linescope
