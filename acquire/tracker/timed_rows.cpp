#include "acquire/tracker/timed_rows.hpp"

#include <fmt/format.h>

#include "acquire/tracker/pose_columns.hpp"

namespace linescope {
namespace {

std::optional<ToolState> state_named(std::string_view word) {
  for (int i = 0; i <= static_cast<int>(ToolState::never_seen); ++i)
    if (name(static_cast<ToolState>(i)) == word) return static_cast<ToolState>(i);
  return std::nullopt;
}

class OneSensorPerRow : public TimedRows {
 public:
  static Result<std::unique_ptr<TimedRows>> open(CsvReader reader) {
    const auto fixed = reader.columns({"time_s", "station"});
    if (!fixed) return tl::unexpected(fixed.error());
    auto pose = PoseColumns::find(reader);
    if (!pose) return tl::unexpected(pose.error());
    return std::unique_ptr<TimedRows>(new OneSensorPerRow(std::move(reader), *fixed, std::move(*pose)));
  }

 protected:
  Result<void> decode(std::vector<PoseSample>& samples) override {
    PoseSample sample;
    sample.time = row_time_;
    const auto station = reader_.integer(station_, 1, kMaxStations);
    if (!station) return tl::unexpected(station.error());
    sample.station = static_cast<std::uint8_t>(*station - 1);
    if (auto read = read_optional(sample); !read) return read;
    if (usable(sample.state) || sample.state == ToolState::distorted_field) {
      const auto pose = pose_.pose(reader_);
      if (!pose) return tl::unexpected(pose.error());
      sample.world_from_sensor = *pose;
    }
    samples.push_back(sample);
    return {};
  }

 private:
  OneSensorPerRow(CsvReader reader, const std::vector<std::size_t>& fixed, PoseColumns pose)
      : TimedRows(std::move(reader)), pose_(std::move(pose)), station_(fixed[1]) {
    time_column_ = fixed[0];
    state_ = reader_.find_column("state");
    frame_count_ = reader_.find_column("frame_count");
    distortion_ = reader_.find_column("distortion");
    arrival_ = reader_.find_column("arrival_s");
  }

  Result<void> read_optional(PoseSample& sample) const {
    sample.state = ToolState::ok;
    if (state_) {
      const auto word = reader_.text(*state_);
      const auto state = word ? state_named(*word) : std::nullopt;
      if (!state) return reader_.complain(fmt::format("state \"{}\" is unknown", word ? *word : ""));
      sample.state = *state;
    }
    if (frame_count_) {
      const auto count = reader_.integer(*frame_count_, 0, std::numeric_limits<std::uint32_t>::max());
      if (!count) return tl::unexpected(count.error());
      sample.frame_count = static_cast<std::uint32_t>(*count);
    }
    return read_measurements(sample);
  }

  Result<void> read_measurements(PoseSample& sample) const {
    if (distortion_ && reader_.text(*distortion_).value_or("nan") != "nan") {
      const auto distortion = reader_.number(*distortion_);
      if (!distortion) return tl::unexpected(distortion.error());
      sample.distortion = static_cast<float>(*distortion);
    }
    if (arrival_) {
      const auto arrival = reader_.seconds(*arrival_);
      if (!arrival) return tl::unexpected(arrival.error());
      sample.arrival = *arrival;
    }
    return {};
  }

  PoseColumns pose_;
  std::size_t station_ = 0;
  std::optional<std::size_t> state_, frame_count_, distortion_, arrival_;
};

class TwoSensorsPerRow : public TimedRows {
 public:
  static Result<std::unique_ptr<TimedRows>> open(CsvReader reader, double mm_per_unit) {
    const auto time = reader.columns({"Time"});
    if (!time) return tl::unexpected(time.error());
    auto first = PoseColumns::find(reader, {"loc1_x", "loc1_y", "loc1_z", "w1", "x1", "y1", "z1"});
    if (!first) return tl::unexpected(first.error());
    auto second = PoseColumns::find(reader, {"loc2_x", "loc2_y", "loc2_z", "w2", "x2", "y2", "z2"});
    if (!second) return tl::unexpected(second.error());
    std::unique_ptr<TwoSensorsPerRow> rows(new TwoSensorsPerRow(std::move(reader), mm_per_unit));
    rows->time_column_ = time->front();
    rows->sensors_[0].columns = std::move(*first);
    rows->sensors_[1].columns = std::move(*second);
    return rows;
  }

 protected:
  Result<void> decode(std::vector<PoseSample>& samples) override {
    for (std::size_t i = 0; i < sensors_.size(); ++i)
      if (auto read = decode_sensor(i, samples); !read) return read;
    return {};
  }

 private:
  struct OneSensor {
    PoseColumns columns;
    std::optional<PoseNumbers> last;
    std::uint32_t count = 0;
  };

  TwoSensorsPerRow(CsvReader reader, double mm_per_unit)
      : TimedRows(std::move(reader)), mm_per_unit_(mm_per_unit) {}

  Result<void> decode_sensor(std::size_t index, std::vector<PoseSample>& samples) {
    OneSensor& sensor = sensors_[index];
    const auto numbers = sensor.columns.numbers(reader_);
    if (!numbers) return tl::unexpected(numbers.error());
    if (sensor.last == *numbers) return {};
    const auto pose = pose_from_numbers(*numbers, mm_per_unit_);
    if (!pose) return reader_.complain(fmt::format("sensor {}: {}", index + 1, pose.error().message));
    sensor.last = *numbers;
    PoseSample sample;
    sample.time = sample.arrival = row_time_;
    sample.frame_count = ++sensor.count;
    sample.station = static_cast<std::uint8_t>(index);
    sample.state = ToolState::ok;
    sample.world_from_sensor = *pose;
    samples.push_back(sample);
    return {};
  }

  double mm_per_unit_;
  std::array<OneSensor, 2> sensors_;
};

}  // namespace

Result<std::unique_ptr<TimedRows>> TimedRows::open(const std::filesystem::path& file, double mm_per_unit) {
  auto reader = CsvReader::open(file);
  if (!reader) return tl::unexpected(reader.error());
  if (reader->has_column("Time") && reader->has_column("w1"))
    return TwoSensorsPerRow::open(std::move(*reader), mm_per_unit);
  return OneSensorPerRow::open(std::move(*reader));
}

Result<bool> TimedRows::next(std::vector<PoseSample>& samples) {
  if (!reader_.next_row()) return false;
  const auto time = reader_.seconds(time_column_);
  if (!time) return tl::unexpected(time.error());
  row_time_ = *time;
  if (auto decoded = decode(samples); !decoded) return tl::unexpected(decoded.error());
  return true;
}

}  // namespace linescope
