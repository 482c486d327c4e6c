// Finding, opening and losing a LIBERTY on a mocked USB bus.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <libusb.h>

#include "acquire/tracker/liberty/find_trackers.hpp"
#include "acquire/tracker/liberty/usb_transport.hpp"
#include "tests/integration/tracker/driver_on_line.hpp"
#include "tests/integration/tracker/fake/fake_usb.hpp"

namespace linescope {
namespace {

using testing::DriverOnLine;
using testing::FakeBus;
using testing::FakeLiberty;
using testing::FakeUsb;
using ::testing::HasSubstr;
using testing::patient_options;

class LibertyUsb : public ::testing::Test {
 protected:
  Error open_error(const std::string& path = "") {
    UsbTransport transport(path);
    const auto opened = transport.open();
    return opened ? Error{ErrorCode::internal, "it opened"} : opened.error();
  }

  FakeBus bus;
  FakeLiberty unit{8};
};

TEST_F(LibertyUsb, NothingOnTheBus) {
  const Error error = open_error();
  EXPECT_EQ(error.code, ErrorCode::not_found);
  EXPECT_EQ(error.message, "LIBERTY: there is none on USB (0f44:ff20); switch it on and plug it in");
}

TEST_F(LibertyUsb, AUnitWithoutFirmware) {
  FakeUsb loader(bus, unit, {.product = 0xff21});
  const Error error = open_error();
  EXPECT_EQ(error.code, ErrorCode::not_found);
  EXPECT_THAT(error.message,
              HasSubstr("the unit on USB 1-2 (0f44:ff21) waits for its firmware; install fxload"));
}

TEST_F(LibertyUsb, AnotherProductOfTheSameMaker) {
  FakeUsb patriot(bus, unit, {.product = 0xef20});
  const Error error = open_error();
  EXPECT_EQ(error.code, ErrorCode::unsupported);
  EXPECT_THAT(error.message, HasSubstr("USB 1-2 (0f44:ef20) is a PATRIOT, which is another product"));
}

TEST_F(LibertyUsb, OneOfSeveralIsChosenByPath) {
  FakeLiberty other(1);
  FakeUsb first(bus, unit, {.device = 10, .port = "2"});
  FakeUsb second(bus, other, {.device = 11, .port = "3"});
  const Error several = open_error();
  EXPECT_EQ(several.code, ErrorCode::usage);
  EXPECT_THAT(several.message, HasSubstr("there are several"));
  EXPECT_THAT(several.message, HasSubstr("1-3"));
  UsbTransport transport("1-3");
  ASSERT_TRUE(transport.open());
  EXPECT_TRUE(second.claimed());
  EXPECT_FALSE(first.claimed());
  EXPECT_THAT(open_error("4-4").message, HasSubstr("there is none on USB 4-4"));
}

TEST_F(LibertyUsb, TheListSaysWhatIsThereAndWhyItCannotBeUsed) {
  FakeLiberty other(1);
  FakeUsb running(bus, unit, {.device = 10, .port = "2"});
  FakeUsb loader(bus, other, {.product = 0xff21, .device = 11, .port = "3"});
  const auto look = [](const std::string& what) {
    const auto found = find_trackers();
    for (const TrackerFinding& finding : found ? *found : std::vector<TrackerFinding>())
      if (finding.what == what) return finding;
    return TrackerFinding{"nowhere", what, std::nullopt};
  };
  EXPECT_EQ(look("LIBERTY").where, "USB 1-2 (0f44:ff20)");
  EXPECT_FALSE(look("LIBERTY").obstacle);
  ASSERT_TRUE(look("LIBERTY without firmware").obstacle);
  EXPECT_THAT(look("LIBERTY without firmware").obstacle->message, HasSubstr("waits for its firmware"));
  running.set_claim_error(EBUSY);
  ASSERT_TRUE(look("LIBERTY").obstacle);
  EXPECT_EQ(look("LIBERTY").obstacle->code, ErrorCode::busy);
  EXPECT_TRUE(unit.commands().empty()) << "looking sends nothing";
}

TEST_F(LibertyUsb, ABusyUnit) {
  FakeUsb usb(bus, unit);
  usb.set_claim_error(EBUSY);
  const Error error = open_error();
  EXPECT_EQ(error.code, ErrorCode::busy);
  EXPECT_THAT(error.message, HasSubstr("is in use by another program"));
}

TEST_F(LibertyUsb, NoPermissionNamesTheUdevRule) {
  UsbFinding finding;
  finding.id = 0xff20;
  finding.path = "1-2";
  const Error error = usb_open_error(finding, LIBUSB_ERROR_ACCESS);
  EXPECT_EQ(error.code, ErrorCode::permission);
  EXPECT_THAT(error.message, HasSubstr("tools/udev/60-linescope-liberty.rules"));
}

TEST_F(LibertyUsb, AKernelDriverStepsAsideAndComesBack) {
  FakeUsb usb(bus, unit);
  usb.set_kernel_driver("usbserial");
  {
    UsbTransport transport("");
    const auto opened = transport.open();
    ASSERT_TRUE(opened) << opened.error().message;
    EXPECT_EQ(usb.kernel_driver(), "");
    EXPECT_TRUE(usb.claimed());
    EXPECT_EQ(usb.queued_in(), 64u) << "many transfers wait for data: a busy host loses nothing for 0.26 s";
  }
  EXPECT_EQ(usb.kernel_driver(), "usbserial");
  EXPECT_FALSE(usb.claimed());
}

TEST_F(LibertyUsb, UnpluggedInTheMiddleOfARead) {
  FakeUsb usb(bus, unit);
  UsbTransport transport("");
  ASSERT_TRUE(transport.open());
  usb.unplug();
  const auto chunk = transport.read(10 * kSecond);
  ASSERT_FALSE(chunk);
  EXPECT_EQ(chunk.error().code, ErrorCode::gone);
  EXPECT_THAT(chunk.error().message, HasSubstr("was unplugged"));
}

TEST_F(LibertyUsb, RenumeratesFromLoaderToUnitAndThroughAReplug) {
  LibertyOptions options = patient_options();
  options.required_at_start = false;
  options.retry_after = 20 * kMillisecond;
  DriverOnLine driver(unit, options);
  {
    FakeUsb loader(bus, unit, {.product = 0xff21, .device = 9});
    ASSERT_TRUE(driver.source().start());
    ASSERT_TRUE(driver.until(
        [&] { return driver.source().status().sentence.find("firmware") != std::string::npos; }));
  }
  {
    FakeUsb usb(bus, unit, {.device = 10});
    ASSERT_TRUE(driver.run_until([&] { return driver.samples().size() >= 8; }));
    EXPECT_TRUE(driver.source().status().delivering);
    usb.unplug();
    ASSERT_TRUE(driver.until([&] { return driver.source().station(7).state == ToolState::disconnected; }));
  }
  unit.power_cycle();
  FakeUsb again(bus, unit, {.device = 11});
  ASSERT_TRUE(driver.run_until([&] { return driver.source().counters().reconnects == 1; }));
  EXPECT_EQ(driver.source().station(7).state, ToolState::ok);
  driver.source().stop();  // before its device goes out of scope
}

}  // namespace
}  // namespace linescope
