#include "acquire/tracker/picture_pose_source.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "acquire/tracker/pose_columns.hpp"

namespace linescope {
namespace {

std::string file_name_of(std::string_view name) {
  return std::filesystem::path(name).filename().string();
}

PoseSample sample_for(const PictureInstant& picture, std::uint32_t number, std::uint8_t station) {
  PoseSample sample;
  sample.time = picture.time;
  sample.frame_count = number;
  sample.station = station;
  sample.state = ToolState::missing;
  return sample;
}

}  // namespace

PicturePoseSource::PicturePoseSource(std::filesystem::path file, std::vector<PictureInstant> pictures,
                                     const PicturePoseOptions& options)
    : file_(std::move(file)), pictures_(std::move(pictures)), options_(options) {
  std::stable_sort(pictures_.begin(), pictures_.end(),
                   [](const PictureInstant& a, const PictureInstant& b) { return a.time < b.time; });
}

Result<void> PicturePoseSource::start() {
  if (options_.station < 0 || options_.station >= kMaxStations)
    return fail(ErrorCode::usage, fmt::format("poses by picture: station {} does not exist, 1 to {} do",
                                              options_.station + 1, kMaxStations));
  if (auto read = read_rows(); !read) return read;
  plan_.clear();
  position_ = 0;
  for (std::uint32_t i = 0; i < pictures_.size(); ++i) plan_picture(pictures_[i], i);
  describe();
  return {};
}

Result<void> PicturePoseSource::read_rows() {
  rows_.clear();
  auto reader = CsvReader::open(file_);
  if (!reader) return tl::unexpected(reader.error());
  const auto columns = PoseColumns::find(*reader);
  const auto frame = reader->columns({"frame"});
  if (!frame) return tl::unexpected(frame.error());
  if (!columns) return tl::unexpected(columns.error());
  while (reader->next_row())
    if (auto read = read_row(*reader, frame->front(), *columns); !read) return read;
  if (!rows_.empty()) return {};
  return fail(ErrorCode::invalid, fmt::format("{}: the pose file has a header but no pose", file_.string()));
}

Result<void> PicturePoseSource::read_row(const CsvReader& reader, std::size_t frame_column,
                                         const PoseColumns& columns) {
  const auto name = reader.text(frame_column);
  if (!name) return tl::unexpected(name.error());
  int station = options_.station;
  if (const auto column = reader.find_column("station")) {
    const auto number = reader.integer(*column, 1, kMaxStations);
    if (!number) return tl::unexpected(number.error());
    station = static_cast<int>(*number) - 1;
  }
  auto& rows = rows_[file_name_of(*name)];
  for (const Row& earlier : rows)
    if (earlier.station == station)
      return fail(ErrorCode::invalid,
                  fmt::format("{}: {} has a pose already, in line {}; remove one of the two", reader.where(),
                              *name, earlier.line));
  rows.push_back({static_cast<std::uint8_t>(station), reader.line(), columns.pose(reader)});
  return {};
}

void PicturePoseSource::plan_picture(const PictureInstant& picture, std::uint32_t number) {
  const auto found = rows_.find(file_name_of(picture.name));
  if (found == rows_.end()) {
    plan_.emplace_back(sample_for(picture, number, static_cast<std::uint8_t>(options_.station)));
    return;
  }
  for (const Row& row : found->second) {
    PoseSample sample = sample_for(picture, number, row.station);
    if (row.pose) {
      sample.state = ToolState::ok;
      sample.world_from_sensor = *row.pose;
    } else {
      plan_.emplace_back(tl::unexpected(row.pose.error()));
    }
    plan_.emplace_back(sample);
  }
}

void PicturePoseSource::describe() {
  std::size_t bad = 0;
  std::size_t missing = 0;
  for (const auto& step : plan_) {
    if (!step)
      ++bad;
    else if (!usable(step->state))
      ++missing;
  }
  std::string sentence =
      fmt::format("{} pictures, poses of {} from {}", pictures_.size(), rows_.size(), file_.string());
  if (missing > 0)
    sentence += fmt::format("; {} pictures without a pose, {} of them for a bad row", missing, bad);
  ledger_.edit([&](TrackerLedger::Books& books) { books.status = {{true, 0, 0}, sentence}; });
}

Result<Pull> PicturePoseSource::next(PoseSample& out) {
  if (position_ >= plan_.size()) return Pull::end;
  const Result<PoseSample>& step = plan_[position_++];
  if (!step) {
    ledger_.edit([](TrackerLedger::Books& books) { ++books.counters.bad_records; });
    return tl::unexpected(step.error());
  }
  out = *step;
  ledger_.enter(out);
  if (!usable(out.state)) ledger_.edit([](TrackerLedger::Books& books) { ++books.counters.missing_poses; });
  return Pull::item;
}

std::string PicturePoseSource::description() const {
  return fmt::format("poses by picture from {}", file_.string());
}

}  // namespace linescope
