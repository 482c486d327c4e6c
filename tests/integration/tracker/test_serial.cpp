// The LIBERTY on a serial line: a pseudo-terminal with the scripted unit at its other end.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "acquire/tracker/liberty/serial_transport.hpp"
#include "tests/integration/tracker/driver_on_line.hpp"
#include "tests/integration/tracker/fake/serial_cable.hpp"

namespace linescope {
namespace {

using testing::DriverOnLine;
using testing::FakeLiberty;
using ::testing::HasSubstr;
using testing::patient_options;
using testing::SerialCable;

LibertyOptions serial_options(const std::string& device) {
  LibertyOptions options = patient_options();
  options.port = LibertyPort::serial;
  options.serial_device = device;
  options.rate_hz = 120;
  options.stations = 0b1;
  options.retry_after = 10 * kMillisecond;
  return options;
}

TEST(LibertySerial, DeliversEverySampleInBinaryAndInText) {
  for (const LibertyFormat format : {LibertyFormat::binary, LibertyFormat::ascii}) {
    FakeLiberty unit(1);
    unit.leave_streaming(true);
    SerialCable cable(unit);
    LibertyOptions options = serial_options(cable.device());
    options.format = format;
    if (format == LibertyFormat::ascii)
      options.ask_timestamp = options.ask_stylus = options.ask_distortion = false;
    DriverOnLine driver(unit, options);
    const auto started = driver.source().start();
    ASSERT_TRUE(started) << started.error().message;
    ASSERT_TRUE(driver.until([&] { return unit.streaming(); }));  // the last command is still on its way
    for (int i = 0; i < 200; ++i) {
      unit.run_cycles(1);
      ASSERT_TRUE(driver.take(1));
    }
    EXPECT_EQ(driver.source().counters().lost, 0u);
    EXPECT_EQ(driver.source().counters().skipped_bytes, 0u);
    const PoseSample& last = driver.samples().back();
    const auto expected = FakeLiberty::pose(0, last.frame_count);
    EXPECT_NEAR(last.world_from_sensor.translation().x(), 10 * expected[0],
                0.006);  // three decimals of a centimetre
  }
}

TEST(LibertySerial, ASecondProgramIsToldThatTheLineIsBusy) {
  FakeLiberty unit(1);
  SerialCable cable(unit);
  SerialTransport first(cable.device(), 115200);
  ASSERT_TRUE(first.open());
  SerialTransport second(cable.device(), 115200);
  const auto opened = second.open();
  ASSERT_FALSE(opened);
  EXPECT_EQ(opened.error().code, ErrorCode::busy);
  EXPECT_THAT(opened.error().message, HasSubstr("is in use by another program"));
  first.close();
  EXPECT_TRUE(second.open());
}

TEST(LibertySerial, NoSuchDeviceAndNoSerialLine) {
  const auto missing = SerialTransport("/dev/does-not-exist", 115200).open();
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, ErrorCode::not_found);
  EXPECT_THAT(missing.error().message, HasSubstr("there is no serial device /dev/does-not-exist"));
  const auto no_line = SerialTransport("/dev/null", 115200).open();
  ASSERT_FALSE(no_line);
  EXPECT_THAT(no_line.error().message, HasSubstr("/dev/null is not a serial line"));
}

TEST(LibertySerial, AUnitThatSwitchedToUsbDoesNotAnswerAndTheHintSaysSo) {
  FakeLiberty unit(1);
  unit.set_dumb(true);
  SerialCable cable(unit);
  LibertyOptions options = serial_options(cable.device());
  options.answer_timeout = 50 * kMillisecond;
  DriverOnLine driver(unit, options);
  const auto started = driver.source().start();
  ASSERT_FALSE(started);
  EXPECT_EQ(started.error().code, ErrorCode::timeout);
  EXPECT_THAT(started.error().message, HasSubstr("if its USB cable is or was plugged in"));
}

TEST(LibertySerial, APulledCableIsNoticed) {
  FakeLiberty unit(1);
  SerialCable cable(unit);
  DriverOnLine driver(unit, serial_options(cable.device()));
  ASSERT_TRUE(driver.source().start());
  ASSERT_TRUE(driver.until([&] { return unit.streaming(); }));
  unit.run_cycles(1);
  ASSERT_TRUE(driver.take(1));
  cable.pull();
  ASSERT_TRUE(driver.take(1));
  EXPECT_EQ(driver.samples().back().state, ToolState::disconnected);
  EXPECT_FALSE(driver.source().status().delivering);
}

}  // namespace
}  // namespace linescope
