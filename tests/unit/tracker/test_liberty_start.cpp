#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "acquire/tracker/liberty/start_up.hpp"
#include "tests/integration/tracker/fake/direct_line.hpp"

namespace linescope {
namespace {

using ::testing::Contains;
using testing::DirectLine;
using testing::DirectTransport;
using ::testing::HasSubstr;
using ::testing::Not;

class LibertyStartTest : public ::testing::Test {
 protected:
  LibertyStartTest() { options.answer_timeout = 100 * kMillisecond; }

  Result<LibertyIdentity> start() {
    DirectTransport transport(line);
    return start_liberty(transport, options);
  }
  void expect_started() {
    const auto identity = start();
    ASSERT_TRUE(identity) << identity.error().message;
    EXPECT_TRUE(line->unit.streaming());
    EXPECT_EQ(line->unit.binary(), options.format == LibertyFormat::binary);
  }
  std::string refusal() {
    const auto identity = start();
    return identity ? "started" : identity.error().message;
  }

  std::shared_ptr<DirectLine> line = std::make_shared<DirectLine>(3);
  LibertyOptions options;
};

TEST_F(LibertyStartTest, FromAFreshUnit) {
  const auto identity = start();
  ASSERT_TRUE(identity) << identity.error().message;
  EXPECT_EQ(identity->detected, 0b111);
  EXPECT_THAT(identity->text, HasSubstr("Polhemus LIBERTY HST 8 Stations"));
  EXPECT_TRUE(identity->remarks.empty()) << identity->remarks.front();
  const auto commands = line->unit.commands();
  for (const char* wanted :
       {"F1", "U1", "R4", "L*,0", "^R*", "^B*", "G0,0,0", "N*,0,0,0", "H*,1.000,0.000,0.000", "X0,1,0,0",
        "Y0,1,0,0", "O*,9,8,11,10,2,7", "@B1", "^U0,ff", "Q0"})
    EXPECT_THAT(commands, Contains(wanted));
  for (const char* question : {"U", "R", "O1", "O3", "H1", "X", "Y", "@B", "^T", "^V"})
    EXPECT_THAT(commands, Contains(question));
  EXPECT_EQ(commands.back(), "C");
}

TEST_F(LibertyStartTest, FromEveryStateSomebodyMayLeaveItIn) {
  const std::vector<std::function<void()>> dirty = {
      [&] { line->unit.leave_streaming(true); },
      [&] { line->unit.leave_streaming(false); },
      [&] { line->unit.leave_half_typed("O*,2,"); },
      [&] { line->unit.set_echo(true); },
      [&] { line->unit.inject("\x01\xffLY\x02\x43garbage"); },
      [&] { line->unit.leave_streaming(true), line->unit.run_cycles(5); },
      [&] { line->unit.leave_streaming(false), line->unit.run_cycles(5), line->unit.leave_half_typed("F"); },
  };
  for (std::size_t i = 0; i < dirty.size(); ++i) {
    SCOPED_TRACE(i);
    line = std::make_shared<DirectLine>(3);
    dirty[i]();
    expect_started();
  }
}

TEST_F(LibertyStartTest, AsciiIsTurnedOnLast) {
  options.format = LibertyFormat::ascii;
  expect_started();
  EXPECT_THAT(line->unit.commands(), Contains("O*,9,8,11,10,2,7,1"));
}

TEST_F(LibertyStartTest, OptionsReachTheUnit) {
  options.rate_hz = 120;
  options.hemisphere = {0, 0, -1};
  options.stations = 0b101;
  options.fifo = false;
  options.position_filter = LibertyFilter{};
  options.ask_stylus = false;
  expect_started();
  for (const char* wanted :
       {"R3", "H*,0.000,0.000,-1.000", "^U0,5", "@B0", "X0.200,0.200,0.800,0.950", "O*,9,8,11,2,7"})
    EXPECT_THAT(line->unit.commands(), Contains(wanted));
  EXPECT_THAT(line->unit.commands(), Not(Contains("O2"))) << "a station that is off is not asked";
}

TEST_F(LibertyStartTest, ADumbUnitGetsThreeQuestionsAndAHint) {
  line->unit.set_dumb(true);
  const auto identity = start();
  ASSERT_FALSE(identity);
  EXPECT_EQ(identity.error().code, ErrorCode::timeout);
  EXPECT_EQ(identity.error().message, "LIBERTY on the direct line: it does not answer; look at the test");
  const auto commands = line->unit.commands();
  EXPECT_EQ(std::count(commands.begin(), commands.end(), "^U0"), 3);
}

TEST_F(LibertyStartTest, AnotherProductIsNamed) {
  line->unit.set_tag({'P', 'A'});
  const auto identity = start();
  ASSERT_FALSE(identity);
  EXPECT_EQ(identity.error().code, ErrorCode::unsupported);
  EXPECT_THAT(identity.error().message, HasSubstr("this is a PATRIOT, not a LIBERTY"));
}

TEST_F(LibertyStartTest, ASettingThatIsNotTakenOverIsFoundByReadingItBack) {
  const std::vector<std::pair<char, std::string>> settings = {
      {'U', "units should be 1 but is 0"},
      {'O', "the output list of station 1 should be 9,8,11,10,2,7 but is 2,4,1"},
      {'X', "the position filter should be 0.000,1.000,0.000,0.000 but is 0.200,0.200,0.800,0.950"},
      {'Y', "the attitude filter should be"},
  };
  for (const auto& [letter, sentence] : settings) {
    line = std::make_shared<DirectLine>(3);
    line->unit.ignore(letter);
    EXPECT_THAT(refusal(), HasSubstr(sentence));
    EXPECT_FALSE(line->unit.streaming());
  }
  options.rate_hz = 120;
  line = std::make_shared<DirectLine>(3);
  line->unit.ignore('R');
  EXPECT_THAT(refusal(), HasSubstr("rate should be 3 but is 4"));
  options.hemisphere = {0, 1, 0};
  line = std::make_shared<DirectLine>(3);
  line->unit.ignore('H');
  EXPECT_THAT(refusal(),
              HasSubstr("hemisphere of station 1 should be 0.000,1.000,0.000 but is 1.000,0.000,0.000"));
  options.hemisphere = {1, 0, 0};
  options.fifo = false;
  line = std::make_shared<DirectLine>(3);
  line->unit.ignore('@');
  EXPECT_THAT(refusal(), HasSubstr("the buffer mode was not taken over"));
}

TEST_F(LibertyStartTest, ARefusedSettingIsReportedInTheUnitsWords) {
  line->unit.refuse('N', 0x07);
  const auto identity = start();
  ASSERT_FALSE(identity);
  EXPECT_EQ(identity.error().code, ErrorCode::invalid);
  EXPECT_THAT(identity.error().message, HasSubstr("it refused N*,0,0,0: parameter above its limit"));
}

TEST_F(LibertyStartTest, SelfTestErrorsAreClearedAndRemarked) {
  line->unit.set_self_test_error(true);
  const auto identity = start();
  ASSERT_TRUE(identity);
  ASSERT_EQ(identity->remarks.size(), 1u);
  EXPECT_THAT(identity->remarks[0], HasSubstr("self-test reports errors"));
  EXPECT_THAT(line->unit.commands(), Contains("^T0"));
}

TEST_F(LibertyStartTest, TooManySensorsForASerialLineAreRefusedWithTheSum) {
  options.port = LibertyPort::serial;
  options.rate_hz = 120;
  EXPECT_THAT(refusal(), HasSubstr("52 bytes x 120 Hz x 3 sensor(s) = 18720 bytes/s"));
  options.stations = 0b1;
  expect_started();
}

TEST_F(LibertyStartTest, AnUnpluggedLineEndsItAtOnce) {
  line->plugged = false;
  const auto identity = start();
  ASSERT_FALSE(identity);
  EXPECT_EQ(identity.error().code, ErrorCode::gone);
}

TEST_F(LibertyStartTest, StoppingLeavesAQuietUnit) {
  expect_started();
  line->unit.run_cycles(3);
  DirectTransport transport(line);
  stop_liberty(transport);
  EXPECT_FALSE(line->unit.streaming());
  EXPECT_FALSE(line->unit.next_packet());
}

}  // namespace
}  // namespace linescope
