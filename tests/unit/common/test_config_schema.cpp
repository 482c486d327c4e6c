// Bad input of each kind, and the promises around it: everything is reported at once, with its place, and
// nothing is filled.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <numbers>

#include "common/config_schema.hpp"

namespace linescope {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

enum class Port { usb, serial };

struct Options {
  double rate_hz = 30;
  float gain = 1.5F;
  double alpha = 14 * (std::numbers::pi / 180);  // radians inside
  int width = 640;
  std::int64_t period = 40'000'000;  // nanoseconds inside
  bool locked = true;
  std::string source = "camera \"one\"";
  std::filesystem::path calibration;
  Port port = Port::usb;
  std::string format = "MJPG";
  std::vector<double> hemisphere{1, 0, 0};
  std::vector<std::string> notes;
};

class Config : public ::testing::Test {
 protected:
  Config() {
    schema.section("camera", "Where the pictures come from.");
    schema.number("camera.rate_hz", o.rate_hz, {.unit = "Hz", .min = 1, .max = 240}, "Pictures per second.");
    schema.number("camera.gain", o.gain, {.min = 0}, "Camera's unit.");
    schema.integer("camera.width", o.width, {.unit = "px", .min = 16, .max = 8192}, "Columns.");
    schema.integer("camera.period_ms", o.period, {.unit = "ms", .min = 1, .scale = 1e6},
                   "Between two pictures.");
    schema.flag("camera.locked", o.locked, "White balance locked.");
    schema.text("camera.source", o.source, "Folder | file | device.");
    schema.choice("camera.format", o.format, {"MJPG", "YUYV"}, "Pixel format.");
    schema.section("laser", "The sheet.");
    schema.number("laser.alpha_deg", o.alpha,
                  {.unit = "deg", .min = 0, .max = 45, .scale = std::numbers::pi / 180}, "Tilt.");
    schema.path("laser.calibration", o.calibration, "File.");
    schema.section("tracker", "The LIBERTY.");
    schema.choice("tracker.port", o.port, {{"usb", Port::usb}, {"serial", Port::serial}},
                  "How it is connected.");
    schema.numbers("tracker.hemisphere", o.hemisphere, {.min = -1, .max = 1}, {3, 3}, "Direction.");
    schema.texts("tracker.notes", o.notes, {0, 2}, "For people.");
  }

  std::vector<ConfigFault> read(std::string_view toml) { return schema.read_text(toml, "scan.toml"); }

  /// The only fault of this text.
  std::string fault(std::string_view toml) {
    const auto faults = read(toml);
    EXPECT_THAT(faults, SizeIs(1));
    return faults.empty() ? "" : faults.front().message;
  }

  Options o;
  ConfigSchema schema;
};

TEST_F(Config, FillsEveryKindOfFieldInInsideUnits) {
  EXPECT_THAT(read(R"(
[camera]
rate_hz = 60
gain = 2.25
width = 1280
period_ms = 25
locked = false
source = "/dev/video0"
format = "YUYV"
[laser]
alpha_deg = 45.0
calibration = "/etc/cal.yaml"
[tracker]
port = "serial"
hemisphere = [0, 0.5, -1]
notes = ["a", "b"]
)"),
              IsEmpty());
  EXPECT_EQ(o.rate_hz, 60);
  EXPECT_EQ(o.gain, 2.25F);
  EXPECT_EQ(o.width, 1280);
  EXPECT_EQ(o.period, 25'000'000);
  EXPECT_FALSE(o.locked);
  EXPECT_EQ(o.source, "/dev/video0");
  EXPECT_EQ(o.format, "YUYV");
  EXPECT_DOUBLE_EQ(o.alpha, std::numbers::pi / 4);
  EXPECT_EQ(o.calibration, "/etc/cal.yaml");
  EXPECT_EQ(o.port, Port::serial);
  EXPECT_EQ(o.hemisphere, (std::vector<double>{0, 0.5, -1}));
  EXPECT_EQ(o.notes, (std::vector<std::string>{"a", "b"}));
}

TEST_F(Config, UnknownKeyNamesFileLineAndNearestName) {
  EXPECT_EQ(fault("# comment\n[camera]\nrate_hx = 60\n"),
            "scan.toml:3: unknown key camera.rate_hx; did you mean camera.rate_hz?");
}

TEST_F(Config, RightKeyInWrongSectionFindsTheRightOne) {
  EXPECT_THAT(fault("[camera]\nhemisphere = [0, 0, 1]\n"), HasSubstr("did you mean tracker.hemisphere?"));
}

TEST_F(Config, UnknownKeyWithoutAnyNearNameSaysWhereAllAreListed) {
  EXPECT_EQ(fault("[camera]\nxylophone_quartet = 1\n"),
            "scan.toml:2: unknown key camera.xylophone_quartet; --print-config shows all that exist");
}

TEST_F(Config, UnknownSectionIsOneFaultHoweverManyKeysItHas) {
  EXPECT_EQ(fault("[camra]\nrate_hz = 30\nwidth = 640\n"),
            "scan.toml:1: unknown section camra; did you mean camera?");
}

TEST_F(Config, ValueInPlaceOfASectionIsExplained) {
  EXPECT_EQ(fault("camera = 5\n"), "scan.toml:1: camera is a section: write [camera] and its keys below");
}

struct BadValue {
  const char* what;
  const char* toml;
  const char* expected;
  ErrorCode code;
};

class ConfigBadValue : public Config, public ::testing::WithParamInterface<BadValue> {};

TEST_P(ConfigBadValue, IsRefusedInOneSentenceAndChangesNothing) {
  const auto faults = read(GetParam().toml);
  ASSERT_THAT(faults, SizeIs(1));
  EXPECT_EQ(faults[0].message, std::string("scan.toml:2: ") + GetParam().expected);
  EXPECT_EQ(faults[0].code, GetParam().code);
  EXPECT_EQ(faults[0].line, 2);
  EXPECT_EQ(schema.origin("camera.rate_hz"), "default");
}

INSTANTIATE_TEST_SUITE_P(
    EachKind, ConfigBadValue,
    ::testing::Values(
        BadValue{"TextForNumber", "[camera]\nrate_hz = 'fast'",
                 "camera.rate_hz must be a number, but is text", ErrorCode::mismatch},
        BadValue{"NumberForText", "[camera]\nsource = 0",
                 "camera.source must be text in quotes, but is a whole number", ErrorCode::mismatch},
        BadValue{"PointForWhole", "[camera]\nwidth = 640.5",
                 "camera.width must be a whole number, but is a number with a point", ErrorCode::mismatch},
        BadValue{"NumberForFlag", "[camera]\nlocked = 1",
                 "camera.locked must be true or false, but is a whole number", ErrorCode::mismatch},
        BadValue{"SectionForNumber", "[camera]\nrate_hz = {a = 1}",
                 "camera.rate_hz must be a number, but is a section", ErrorCode::mismatch},
        BadValue{"DateForText", "[camera]\nsource = 2020-01-01",
                 "camera.source must be text in quotes, but is a date or time", ErrorCode::mismatch},
        BadValue{"AboveRange", "[camera]\nrate_hz = 900",
                 "camera.rate_hz is 900, but must be between 1 and 240 Hz", ErrorCode::invalid},
        BadValue{"BelowOpenRange", "[camera]\ngain = -0.5", "camera.gain is -0.5, but must be at least 0",
                 ErrorCode::invalid},
        BadValue{"NotANumber", "[camera]\nrate_hz = nan", "camera.rate_hz is nan, but must be finite",
                 ErrorCode::invalid},
        BadValue{"Infinite", "[camera]\ngain = inf", "camera.gain is inf, but must be finite",
                 ErrorCode::invalid},
        BadValue{"Overflow", "[camera]\nperiod_ms = 9223372036854775807",
                 "camera.period_ms is 9223372036854775807, which is too large to be kept",
                 ErrorCode::invalid},
        BadValue{"Word", "[tracker]\nport = \"sreial\"",
                 "tracker.port is \"sreial\", but must be \"usb\" or \"serial\"; did you mean \"serial\"?",
                 ErrorCode::invalid},
        BadValue{"ListTooShort", "[tracker]\nhemisphere = [0, 1]",
                 "tracker.hemisphere has 2 items, but must have 3 items", ErrorCode::invalid},
        BadValue{"ListTooLong", "[tracker]\nnotes = ['a', 'b', 'c']",
                 "tracker.notes has 3 items, but must have 0 to 2 items", ErrorCode::invalid},
        BadValue{"ListItemRange", "[tracker]\nhemisphere = [0, 0, 7]",
                 "tracker.hemisphere is 7, but must be between -1 and 1", ErrorCode::invalid},
        BadValue{"ListItemType", "[tracker]\nnotes = ['a', 2]",
                 "tracker.notes must be a list of texts, but is a whole number", ErrorCode::mismatch},
        BadValue{"NumberForList", "[tracker]\nhemisphere = 1",
                 "tracker.hemisphere must be a list of numbers, but is a whole number", ErrorCode::mismatch}),
    [](const auto& test) { return test.param.what; });

TEST_F(Config, AllFaultsAreReportedInTheOrderOfTheFile) {
  const auto faults = read("[tracker]\nport = 3\n[camera]\nwidth = 1\nrate_hx = 2\n[camera2]\na = 1\n");
  ASSERT_THAT(faults, SizeIs(4));
  EXPECT_EQ(faults[0].line, 2);
  EXPECT_EQ(faults[1].line, 4);
  EXPECT_EQ(faults[2].line, 5);
  EXPECT_EQ(faults[3].line, 6);
}

TEST_F(Config, OneFaultLeavesEveryFieldAsItWas) {
  EXPECT_THAT(read("[camera]\nwidth = 800\nrate_hz = 1000\n"), SizeIs(1));
  EXPECT_EQ(o.width, 640);
  EXPECT_EQ(schema.origin("camera.width"), "default");
}

TEST_F(Config, SyntaxErrorHasItsLine) {
  const auto faults = read("[camera]\nrate_hz = \n");
  ASSERT_THAT(faults, SizeIs(1));
  EXPECT_THAT(faults[0].message, HasSubstr("scan.toml:2: not valid TOML: "));
  EXPECT_EQ(faults[0].code, ErrorCode::unreadable);
}

TEST_F(Config, KeyGivenTwiceIsRefusedWithItsLine) {
  EXPECT_THAT(fault("[camera]\nwidth = 640\nwidth = 800\n"), HasSubstr("scan.toml:3: "));
}

TEST_F(Config, MissingFileSaysHowToGetOne) {
  const auto faults = schema.read_file("/nowhere/scan.toml");
  ASSERT_THAT(faults, SizeIs(1));
  EXPECT_EQ(faults[0].code, ErrorCode::not_found);
  EXPECT_EQ(faults[0].message,
            "there is no configuration file /nowhere/scan.toml; --print-config > scan.toml writes one to "
            "start from");
}

TEST_F(Config, FolderInPlaceOfAFileIsUnreadable) {
  const auto faults = schema.read_file(std::filesystem::temp_directory_path());
  ASSERT_THAT(faults, SizeIs(1));
  EXPECT_EQ(faults[0].code, ErrorCode::unreadable);
}

TEST_F(Config, RelativePathsCountFromTheFolderOfTheFile) {
  EXPECT_THAT(schema.read_text("[laser]\ncalibration = '../cal/a.yaml'\n", "/etc/scan/scan.toml"), IsEmpty());
  EXPECT_EQ(o.calibration, "/etc/cal/a.yaml");
  EXPECT_THAT(schema.read_text("[laser]\ncalibration = ''\n", "/etc/scan/scan.toml"), IsEmpty());
  EXPECT_EQ(o.calibration, "");
}

TEST_F(Config, SecondFileAddsToTheFirst) {
  EXPECT_THAT(schema.read_text("[camera]\nwidth = 800\nrate_hz = 10\n", "a.toml"), IsEmpty());
  EXPECT_THAT(schema.read_text("[camera]\nwidth = 1024\n", "b.toml"), IsEmpty());
  EXPECT_EQ(o.width, 1024);
  EXPECT_EQ(o.rate_hz, 10);
  EXPECT_EQ(schema.origin("camera.width"), "b.toml:2");
  EXPECT_EQ(schema.origin("camera.rate_hz"), "a.toml:3");
  EXPECT_EQ(schema.origin("camera.gain"), "default");
}

TEST_F(Config, CommandLineTakesTomlAndBareText) {
  EXPECT_TRUE(schema.set("camera.rate_hz=25"));
  EXPECT_TRUE(schema.set("camera.source=/dev/video3"));
  EXPECT_TRUE(schema.set("tracker.port=serial"));
  EXPECT_TRUE(schema.set("tracker.hemisphere=[0,1,0]"));
  EXPECT_EQ(o.rate_hz, 25);
  EXPECT_EQ(o.source, "/dev/video3");
  EXPECT_EQ(o.port, Port::serial);
  EXPECT_EQ(o.hemisphere[1], 1);
  EXPECT_TRUE(schema.set("camera.source=0")) << "a camera's index is text, too";
  EXPECT_EQ(o.source, "0");
  EXPECT_EQ(schema.origin("camera.source"), "command line");
}

TEST_F(Config, CommandLineFaultsAreSentences) {
  EXPECT_EQ(schema.set("camera.rate_hz").error().message,
            "\"camera.rate_hz\" is not of the form section.key=value, for example camera.rate_hz=30");
  EXPECT_EQ(schema.set("camera.rates_hz=3").error().message,
            "unknown key camera.rates_hz; did you mean camera.rate_hz?");
  EXPECT_EQ(schema.set("camera.rate_hz=0").error().message,
            "command line: camera.rate_hz is 0, but must be between 1 and 240 Hz");
  EXPECT_EQ(schema.set("camera.rate_hz=fast").error().message,
            "command line: camera.rate_hz must be a number, but is text");
}

TEST_F(Config, EffectiveValuesReadBackToTheLastBit) {
  o.rate_hz = 0.1 + 29.2;
  o.alpha = 14.3 * (std::numbers::pi / 180);
  o.gain = 0.1F;
  o.source = "tab\t quote\" backslash\\ newline\n";
  o.hemisphere = {1.0 / 3, -1e-17, 1};
  o.port = Port::serial;
  const Options before = o;
  const std::string printed = schema.to_toml();
  o = Options{};
  EXPECT_THAT(read(printed), IsEmpty()) << printed;
  EXPECT_EQ(o.rate_hz, before.rate_hz);
  EXPECT_EQ(o.alpha, before.alpha);
  EXPECT_EQ(o.gain, before.gain);
  EXPECT_EQ(o.source, before.source);
  EXPECT_EQ(o.hemisphere, before.hemisphere);
  EXPECT_EQ(o.port, before.port);
  EXPECT_EQ(o.period, before.period);
}

TEST_F(Config, PrintedConfigurationExplainsEachKey) {
  EXPECT_THAT(read("[camera]\nrate_hz = 60\n"), IsEmpty());
  const std::string printed = schema.to_toml();
  EXPECT_THAT(printed, HasSubstr("# Where the pictures come from.\n[camera]\n"));
  EXPECT_THAT(
      printed,
      HasSubstr(
          "# Pictures per second.\n# between 1 and 240 Hz; from scan.toml:2, default 30\nrate_hz = 60\n"));
  EXPECT_THAT(printed, HasSubstr("alpha_deg = 14\n"))
      << "degrees as a person wrote them, not 14.000000000000002";
}

TEST_F(Config, MarkdownHasOneRowPerKey) {
  const std::string table = schema.to_markdown();
  EXPECT_THAT(table,
              HasSubstr("| `camera.rate_hz` | Hz | between 1 and 240 | `30` | Pictures per second. |\n"));
  EXPECT_THAT(table, HasSubstr("Folder \\| file \\| device."));
  EXPECT_THAT(table, HasSubstr("| `camera.period_ms` | ms | whole, at least 1 | `40` |"));
}

TEST(ConfigDeclaration, MistakesOfTheProgramAreReportedAndStopReading) {
  double value = 5;
  ConfigSchema schema;
  schema.section("a", "A.");
  schema.number("a.x", value, {.min = 10}, "Default out of range.");
  schema.number("a.x", value, {}, "Twice.");
  schema.number("b.y", value, {}, "No section.");
  EXPECT_THAT(schema.check(), SizeIs(3));
  EXPECT_THAT(schema.read_text("", "empty.toml"), SizeIs(3));
  EXPECT_EQ(schema.check()[0].code, ErrorCode::internal);
}

TEST_F(Config, TheseDeclarationsAreCorrect) {
  EXPECT_THAT(schema.check(), IsEmpty());
}

}  // namespace
}  // namespace linescope
