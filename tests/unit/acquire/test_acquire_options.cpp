#include <gtest/gtest.h>

#include "acquire/acquire_options.hpp"
#include "acquire/command_line.hpp"

namespace linescope {
namespace {

TEST(AcquireOptions, DeclarationsAreWithoutMistakeAndDefaultsAreValid) {
  AcquireOptions options;
  ConfigSchema schema;
  declare(schema, options);
  for (const ConfigFault& fault : schema.check()) ADD_FAILURE() << fault.message;
  EXPECT_TRUE(validate(options)) << validate(options).error().message;
}

TEST(AcquireOptions, WhatNoSingleKeyShowsIsRefused) {
  AcquireOptions shared_station;
  shared_station.tracker.roles.harvester = shared_station.tracker.roles.endoscope;
  EXPECT_FALSE(validate(shared_station));
  AcquireOptions half_twin;
  half_twin.tracker.source = "none";
  EXPECT_FALSE(validate(half_twin));
  AcquireOptions no_calibration;
  no_calibration.camera.source = no_calibration.tracker.source = "somewhere";
  EXPECT_FALSE(validate(no_calibration));
  AcquireOptions no_endoscope;
  no_endoscope.tracker.roles.endoscope = -1;
  EXPECT_FALSE(validate(no_endoscope));
}

tl::expected<CommandLine, Refusal> parsed(std::vector<const char*> arguments) {
  arguments.insert(arguments.begin(), "linescope-acquire");
  return read_command_line(static_cast<int>(arguments.size()), arguments.data());
}

TEST(CommandLine, OptionsAddUpInTheOrderTheyAreGiven) {
  const auto line =
      parsed({"--seed", "7", "--set", "laser.colour=red", "--fast", "--set", "laser.min_snr=9"});
  ASSERT_TRUE(line) << line.error().message;
  EXPECT_EQ(line->options.twin.seed, 7);
  EXPECT_EQ(line->options.laser.colour, LaserColour::red);
  EXPECT_EQ(line->options.run.pace, Pace::fast);
  EXPECT_DOUBLE_EQ(line->options.laser.min_snr, 9);
  EXPECT_EQ(line->task, CommandLine::Task::run);
}

TEST(CommandLine, StationsCountFromOneAsOnTheUnit) {
  const auto line = parsed({"--set", "tracker.endoscope_station=3", "--set", "tracker.object_station=0",
                            "--set", "tracker.harvester_station=8", "--set", "liberty.stations=[3, 8]"});
  ASSERT_TRUE(line) << line.error().message;
  EXPECT_EQ(line->options.tracker.roles.endoscope, 2);
  EXPECT_EQ(line->options.tracker.roles.object, -1);
  EXPECT_EQ(line->options.tracker.roles.harvester, 7);
  EXPECT_EQ(line->options.tracker.liberty.stations, 0b1000'0100);
  EXPECT_EQ(parsed({"--set", "tracker.endoscope_station=0"}).error().exit, ExitCode::configuration);
  EXPECT_EQ(parsed({"--set", "liberty.stations=[1.5]"}).error().exit, ExitCode::configuration);
}

TEST(CommandLine, EverySettingOfTheUnitHasItsKey) {
  const auto line = parsed({"--set", "liberty.hemisphere=[0, 0, -1]", "--set",
                            "liberty.position_filter=[0.2, 0.2, 0.8, 0.95]", "--set", "liberty.format=ascii",
                            "--set", "liberty.fifo=false", "--set", "liberty.ask_stylus=false", "--set",
                            "liberty.silence_limit_ms=250", "--set", "liberty.answer_timeout_ms=125"});
  ASSERT_TRUE(line) << line.error().message;
  const LibertyOptions& liberty = line->options.tracker.liberty;
  EXPECT_EQ(liberty.hemisphere, Eigen::Vector3d(0, 0, -1));
  ASSERT_TRUE(liberty.position_filter);
  EXPECT_DOUBLE_EQ(liberty.position_filter->factor, 0.95);
  EXPECT_FALSE(liberty.attitude_filter);
  EXPECT_EQ(liberty.format, LibertyFormat::ascii);
  EXPECT_FALSE(liberty.fifo);
  EXPECT_FALSE(liberty.ask_stylus);
  EXPECT_EQ(liberty.silence_limit, 250 * kMillisecond);
  EXPECT_EQ(liberty.answer_timeout, 125 * kMillisecond);
  EXPECT_EQ(parsed({"--set", "liberty.attitude_filter=[0.2]"}).error().exit, ExitCode::configuration);
}

TEST(CommandLine, HelpAndVersionStopThere) {
  const auto help = parsed({"--help"});
  ASSERT_TRUE(help);
  EXPECT_EQ(help->task, CommandLine::Task::stop_here);
  EXPECT_NE(help->printed.find("Not for clinical use"), std::string::npos);
  const auto version = parsed({"--version"});
  ASSERT_TRUE(version);
  EXPECT_EQ(version->printed.rfind("linescope-acquire ", 0), 0u);
}

TEST(CommandLine, RefusalsCarryTheExitCode) {
  EXPECT_EQ(parsed({"--sed", "1"}).error().exit, ExitCode::usage);
  EXPECT_EQ(parsed({"--config", "/no/such/file.toml"}).error().exit, ExitCode::configuration);
  EXPECT_EQ(parsed({"--set", "twin.seed=minus one"}).error().exit, ExitCode::usage);
}

}  // namespace
}  // namespace linescope
