// The daemon as a service: what it says where, its help, and the unit file that is shipped.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <regex>
#include <sstream>

#include "tests/integration/acquire/daemon_under_test.hpp"

namespace linescope::testing {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using ::testing::Not;

std::string content(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

std::vector<std::string> short_run(std::vector<std::string> more) {
  std::vector<std::string> all{"--set", "twin.duration_s=0.2", "--fast", "--exit-at-end"};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

TEST(Log, LevelsGoToStandardErrorAndToAFile) {
  TemporaryFolder folder;
  const auto file = folder.path() / "acquire.log";
  const Outcome informed = run_daemon_to_end(short_run({"--log-file", file}));
  EXPECT_EQ(informed.exit_code, 0);
  EXPECT_THAT(informed.said, HasSubstr("[info] segment linescope-test"));
  EXPECT_THAT(content(file), HasSubstr("[info] segment linescope-test"));
  const Outcome quiet = run_daemon_to_end(short_run({"--log-level", "warning"}));
  EXPECT_EQ(quiet.said, "");
  // A refusal is in the file as well.
  run_daemon_to_end({"--camera", "/no/such/folder", "--tracker", "none", "--calibration", "thesis-camera-i",
                     "--log-file", file});
  EXPECT_THAT(content(file), HasSubstr("[error] there is no file or folder /no/such/folder"));
}

TEST(Log, TheJournalGetsItsOwnMarksAndOnlyTheJournal) {
  const Outcome marked = run_daemon_to_end(short_run({"--set", "log.style=journal"}));
  EXPECT_THAT(marked.said, HasSubstr("<6>segment linescope-test"));
  // systemd's own way of telling: device and inode of the stream it gave us.
  TemporaryFolder folder;
  const auto file = folder.path() / "stderr";
  std::ofstream(file).close();
  struct stat status {};
  ASSERT_EQ(::stat(file.c_str(), &status), 0);
  const std::string stream = std::to_string(status.st_dev) + ":" + std::to_string(status.st_ino);
  const auto run = [&](const std::string& journal_stream) {
    ChildProcess daemon(
        {"sh", "-c",
         "exec " LINESCOPE_ACQUIRE " --set twin.duration_s=0.2 --fast --exit-at-end --segment " +
             unique_segment() + " 2>" + file.string()},
        {"JOURNAL_STREAM=" + journal_stream});
    EXPECT_TRUE(daemon.wait(30s));
    return content(file);
  };
  EXPECT_THAT(run(stream), HasSubstr("<6>segment"));
  EXPECT_THAT(run("1:1"), Not(HasSubstr("<6>segment")));
}

TEST(Help, NamesEveryOptionEveryExitCodeAndExamples) {
  ChildProcess help({LINESCOPE_ACQUIRE, "--help"});
  ASSERT_TRUE(help.wait(10s));
  const std::string text = help.standard_output();
  for (const char* word : {"--camera",
                           "--tracker",
                           "--calibration",
                           "--config",
                           "--set",
                           "--record",
                           "--replay",
                           "--scan",
                           "--fast",
                           "--exit-at-end",
                           "--segment",
                           "--seed",
                           "--truth",
                           "--check",
                           "--list",
                           "--print-config",
                           "--log-level",
                           "--log-file",
                           "--version",
                           "Exit codes:",
                           "Signals:",
                           "Examples:",
                           "SIGTERM",
                           "7 already running",
                           "Not for clinical use"})
    EXPECT_THAT(text, HasSubstr(word));
}

TEST(Check, StartsNothingAndLeavesNothing) {
  TemporaryFolder folder;
  const auto truth = folder.path() / "truth.json";
  const auto recording = folder.path() / "scan";
  const std::string segment = unique_segment();
  ChildProcess check(
      {LINESCOPE_ACQUIRE, "--check", "--segment", segment, "--truth", truth, "--record", recording});
  const auto end = check.wait(20s);
  ASSERT_TRUE(end);
  EXPECT_EQ(end->code, 0) << check.standard_error();
  EXPECT_THAT(check.standard_output(), HasSubstr("camera: "));
  EXPECT_THAT(check.standard_output(), HasSubstr("calibration: "));
  EXPECT_FALSE(std::filesystem::exists(truth));
  EXPECT_FALSE(std::filesystem::exists(recording));
  EXPECT_TRUE(leftovers(segment).empty());
  std::filesystem::create_directory(recording);
  std::ofstream(recording / "notes.txt") << "mine";
  const Outcome used = run_daemon_to_end({"--check", "--record", recording});
  EXPECT_EQ(used.exit_code, 3);
  EXPECT_THAT(used.said, HasSubstr("is not empty"));
}

/// The command that systemd would run is one the daemon understands.
TEST(SystemdUnit, RunsACommandLineThatExists) {
  const std::string unit = content(LINESCOPE_UNIT_FILE);
  std::smatch match;
  ASSERT_TRUE(std::regex_search(unit, match, std::regex("ExecStart=\\S*/linescope-acquire (.*)")));
  std::istringstream words(match[1].str());
  TemporaryFolder folder;
  const auto config = folder.path() / "acquire.toml";
  std::ofstream(config) << "[run]\nscan_at_start = false\n";
  std::vector<std::string> arguments{LINESCOPE_ACQUIRE};
  for (std::string word; words >> word;)
    arguments.push_back(word.find(".toml") != std::string::npos ? config.string() : word);
  arguments.push_back("--print-config");
  ChildProcess daemon(arguments);
  const auto end = daemon.wait(10s);
  ASSERT_TRUE(end);
  EXPECT_EQ(end->code, 0) << daemon.standard_error();
  // Ends that a restart does not mend are not restarted.
  EXPECT_THAT(unit, HasSubstr("RestartPreventExitStatus=2 3 4 7"));
}

}  // namespace
}  // namespace linescope::testing
