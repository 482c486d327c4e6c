// Readers in Python that know nothing but docs/segment.md, against a publisher at full speed.
#include "tests/integration/ipc/publisher_fixture.hpp"

namespace linescope::testing {
namespace {

const std::string kSource = LINESCOPE_SOURCE_DIR;
const std::string kPython = LINESCOPE_PYTHON;

#define LINESCOPE_NEEDS_PYTHON()                                                               \
  do {                                                                                         \
    if (kPython.empty()) {                                                                     \
      if (std::getenv("CI") != nullptr) GTEST_FAIL() << "python3 or its numpy is missing";     \
      GTEST_SKIP() << "python3 with numpy is not installed (packages python3, python3-numpy)"; \
    }                                                                                          \
  } while (false)

using Python = PublisherTest;

TEST_F(Python, AReaderMadeFromTheTablesAloneReadsEverything) {
  LINESCOPE_NEEDS_PYTHON();
  for (const std::string rate : {"100", "0"}) {
    start_publisher(rate);
    const Finished finished = run({kPython, "-B", kSource + "/tests/integration/ipc/independent_reader.py",
                                   name_, kSource + "/docs/segment.md"});
    EXPECT_EQ(finished.exit_code, 0) << finished.output;
    EXPECT_NE(finished.output.find("lines_checked"), std::string::npos);
  }
}

TEST_F(Python, TheExampleForViewersReadsEverythingAndItsLayoutIsTheDocumented) {
  LINESCOPE_NEEDS_PYTHON();
  start_publisher("200");
  const Finished finished = run({kPython, "-B", kSource + "/tests/integration/ipc/check_attach.py",
                                 kSource + "/tools", name_, kSource + "/docs/segment.md"});
  EXPECT_EQ(finished.exit_code, 0) << finished.output;
}

TEST_F(Python, TheExampleSavesPointsAndExplainsAMissingDaemon) {
  LINESCOPE_NEEDS_PYTHON();
  start_publisher("200");
  const std::string csv = log_ + ".csv";
  const Finished saved = run({kPython, "-B", kSource + "/tools/attach.py", name_, "--save", csv});
  EXPECT_EQ(saved.exit_code, 0) << saved.output;
  std::ifstream in(csv);
  std::string head;
  std::getline(in, head);
  EXPECT_EQ(head, "x_mm,y_mm,z_mm,intensity,sd_mm");
  ::unlink(csv.c_str());
  const Finished missing = run({kPython, "-B", kSource + "/tools/attach.py", "no-such-segment", "--once"});
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_NE(missing.output.find("no linescope daemon"), std::string::npos) << missing.output;
}

TEST_F(Python, TheJsonOfInspectIsJson) {
  LINESCOPE_NEEDS_PYTHON();
  start_publisher("100");
  const std::string program =
      "import json, sys\n"
      "s = json.loads(sys.argv[1])\n"
      "assert s['life'] == 'live' and s['state'] == 'scanning', s\n"
      "assert s['counters']['lines_published'] > 0, s\n"
      "assert len(s['sensors']) == 8 and s['sensors'][0]['name'] == 'endoscope', s\n"
      "assert s['sensors'][0]['rate']['nominal_hz'] == 240, s\n"
      "assert len(s['sensors'][0]['position_mm']) == 3, s\n"
      "assert s['scan']['lines'] > 0 and s['camera']['rate']['samples'] > 0, s\n";
  const Finished finished = run({kPython, "-B", "-c", program, inspect({"--json"}).output});
  EXPECT_EQ(finished.exit_code, 0) << finished.output;
}

}  // namespace
}  // namespace linescope::testing
