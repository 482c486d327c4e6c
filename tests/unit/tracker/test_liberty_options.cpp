#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "acquire/tracker/liberty/commands.hpp"
#include "acquire/tracker/liberty/error_words.hpp"
#include "acquire/tracker/liberty/usb_products.hpp"

namespace linescope {
namespace {

using ::testing::HasSubstr;
namespace cmd = liberty_command;

LibertyOptions serial(int rate, std::uint8_t stations) {
  LibertyOptions options;
  options.port = LibertyPort::serial;
  options.rate_hz = rate;
  options.stations = stations;
  return options;
}

TEST(LibertyOptions, TheDefaultsAreValid) {
  EXPECT_TRUE(validate(LibertyOptions{}));
}

TEST(LibertyOptions, ASerialLineThatIsTooSlowIsRefusedWithTheSum) {
  const auto refused = validate(serial(240, 0b1));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::invalid);
  EXPECT_THAT(refused.error().message, HasSubstr("52 bytes x 240 Hz x 1 sensor(s) = 12480 bytes/s"));
  EXPECT_THAT(refused.error().message, HasSubstr("115200 baud carry 11520 bytes/s"));
}

TEST(LibertyOptions, WhatFitsIntoASerialLineIsAccepted) {
  EXPECT_TRUE(validate(serial(120, 0b1)));  // 6240 of 11520
  EXPECT_FALSE(validate(serial(120, 0b11)));
  LibertyOptions lean = serial(240, 0b1);
  lean.ask_timestamp = lean.ask_distortion = lean.ask_stylus = false;
  EXPECT_TRUE(validate(lean));  // 40 bytes: 9600 of 11520
  lean.ask_distortion = true;
  EXPECT_TRUE(validate(lean));  // 44 bytes: 10560, 92 %
  lean.ask_stylus = true;
  EXPECT_FALSE(validate(lean));  // 48 bytes: 11520, full to the last byte
  lean.baud = 38400;
  lean.rate_hz = 120;
  EXPECT_FALSE(validate(lean));
}

TEST(LibertyOptions, TextNeedsMoreRoomThanBinary) {
  LibertyOptions options = serial(120, 0b1);
  options.format = LibertyFormat::ascii;
  EXPECT_GT(stream_bytes_per_second(options, 1), 1.5 * stream_bytes_per_second(serial(120, 0b1), 1));
}

TEST(LibertyOptions, EveryFaultHasItsSentence) {
  const auto message = [](auto change) {
    LibertyOptions options;
    change(options);
    const auto result = validate(options);
    return result ? std::string("accepted") : result.error().message;
  };
  EXPECT_THAT(message([](auto& o) { o.rate_hz = 60; }),
              HasSubstr("rate_hz is 60, a LIBERTY does 120 and 240"));
  EXPECT_THAT(message([](auto& o) { o.distortion_limit = 0; }), HasSubstr("distortion_limit is 0"));
  EXPECT_THAT(message([](auto& o) { o.missing_after = 1; }), HasSubstr("missing_after"));
  EXPECT_THAT(message([](auto& o) { o.hemisphere.x() = std::nan(""); }), HasSubstr("hemisphere"));
  EXPECT_THAT(message([](auto& o) { o.device_latency = -1; }), HasSubstr("device_latency"));
  EXPECT_THAT(message([](auto& o) { o.answer_timeout = 0; }), HasSubstr("answer_timeout"));
  EXPECT_THAT(message([](auto& o) { o.position_filter = LibertyFilter{.high = 1.5}; }),
              HasSubstr("position filter"));
  EXPECT_THAT(message([](auto& o) { o.attitude_filter = LibertyFilter{.low = 0.9}; }),
              HasSubstr("low must be smaller"));
  EXPECT_THAT(message([](auto& o) { o = serial(120, 1), o.baud = 9600; }), HasSubstr("baud is 9600"));
  EXPECT_THAT(message([](auto& o) { o = serial(120, 1), o.serial_device = ""; }),
              HasSubstr("serial_device is empty"));
}

TEST(OutputLists, SizesAreThoseOfTheManualsExamples) {
  const auto size = [](std::initializer_list<int> items) {
    OutputList list;
    for (const int item : items) list.add(static_cast<OutputItem>(item));
    return list.body_size() + 8;
  };
  EXPECT_EQ(size({8, 9, 11, 3, 7}), 48u);  // station_t of the TUM driver
  EXPECT_EQ(size({2, 7, 8, 0}), 41u);      // VRPN
  EXPECT_EQ(size({2, 7}), 36u);
  EXPECT_EQ(size({2, 4, 1}), 34u);  // the unit's default
}

TEST(OutputLists, OffsetsFollowTheOrder) {
  const OutputList list = OutputList::for_options({});
  EXPECT_EQ(list.text(), "9,8,11,10,2,7");
  EXPECT_EQ(list.offset_of(OutputItem::frame_count), 0u);
  EXPECT_EQ(list.offset_of(OutputItem::quaternion), 28u);
  EXPECT_FALSE(list.offset_of(OutputItem::euler));
}

TEST(Commands, AreWhatTheManualSays) {
  EXPECT_EQ(cmd::stop(), "P");
  EXPECT_EQ(cmd::start_continuous(), "C\r");
  EXPECT_EQ(cmd::ask_station_map(),
            "\x15"
            "0\r");
  EXPECT_EQ(cmd::set_station_map(0x2f),
            "\x15"
            "0,2f\r");
  EXPECT_EQ(cmd::output(OutputList::for_options({})), "O*,9,8,11,10,2,7\r");
  EXPECT_EQ(cmd::rate(240), "R4\r");
  EXPECT_EQ(cmd::rate(120), "R3\r");
  EXPECT_EQ(cmd::hemisphere({0, 0, -2}), "H*,0.000,0.000,-1.000\r");
  EXPECT_EQ(cmd::hemisphere({0, 0, 0}), "H*,0.000,0.000,0.000\r");
  EXPECT_EQ(cmd::position_filter(std::nullopt), "X0,1,0,0\r");
  EXPECT_EQ(cmd::attitude_filter(LibertyFilter{}), "Y0.200,0.200,0.800,0.950\r");
  EXPECT_EQ(cmd::fifo(false), "@B0\r");
  EXPECT_EQ(cmd::readable(cmd::reset_alignment()), "^R*");
}

TEST(ErrorWords, EveryCodeOfTheManualHasWordsAndAWorth) {
  for (std::uint8_t code = 1; code <= 0x19; ++code) EXPECT_FALSE(error_words(code).empty()) << int{code};
  for (const char letter : {'a', 'g', 'A', 'G', 'I', 'u'})
    EXPECT_TRUE(known_error(static_cast<std::uint8_t>(letter)));
  EXPECT_EQ(error_words('c'), "source coils X and Y failed");
  EXPECT_EQ(error_words(0x07), "parameter above its limit");
  EXPECT_TRUE(error_words(' ').empty());
  EXPECT_FALSE(known_error('z'));
  EXPECT_FALSE(known_error(0x80));
  EXPECT_EQ(state_for_error(0), ToolState::ok);
  EXPECT_EQ(state_for_error('I'), ToolState::ok);
  EXPECT_EQ(state_for_error('u'), ToolState::out_of_view);
  EXPECT_EQ(state_for_error('D'), ToolState::missing);
}

TEST(UsbProducts, TheDataPipeIsNotTheFirstInEndpoint) {
  const UsbProduct* high_speed = find_usb_product(0xff20);
  ASSERT_NE(high_speed, nullptr);
  EXPECT_EQ(high_speed->in, 0x88);
  EXPECT_EQ(high_speed->out, 0x04);
  EXPECT_EQ(find_usb_product(0xff21)->kind, UsbProduct::Kind::loader);
  EXPECT_EQ(find_usb_product(0xef20)->kind, UsbProduct::Kind::other);
  EXPECT_EQ(find_usb_product(0x1234), nullptr);
}

}  // namespace
}  // namespace linescope
