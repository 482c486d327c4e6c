// Small helpers shared by the tracker's tests.
#pragma once

#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include "acquire/tracker/tracker_source.hpp"
#include "tests/support/child_process.hpp"

namespace linescope::testing {

inline PoseSample good_sample(int station, Nanoseconds time, const Eigen::Quaterniond& rotation,
                              const Eigen::Vector3d& position) {
  PoseSample sample;
  sample.time = time;
  sample.station = static_cast<std::uint8_t>(station);
  sample.state = ToolState::ok;
  sample.world_from_sensor = {rotation, position};
  return sample;
}

inline PoseSample good_sample(int station, Nanoseconds time) {
  return good_sample(station, time, Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero());
}

/// A file with this content in a folder of its own, removed at the end of the test.
class TextFile {
 public:
  TextFile(const std::string& name, const std::string& content) : path_(folder_ / name) {
    std::ofstream(path_) << content;
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  TemporaryFolder folder_;
  std::filesystem::path path_;
};

/// Everything a stepped source has to say, until its end.
struct Told {
  std::vector<PoseSample> samples;
  std::vector<Error> errors;
};

inline Told read_all(TrackerSource& source) {
  Told told;
  PoseSample sample;
  for (;;) {
    const auto pull = source.next(sample);
    if (!pull)
      told.errors.push_back(pull.error());
    else if (*pull == Pull::item)
      told.samples.push_back(sample);
    else
      return told;
  }
}

}  // namespace linescope::testing
