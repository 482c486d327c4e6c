#include "acquire/record/recorded_camera.hpp"

#include <fmt/format.h>

#include <utility>

#include "acquire/record/recording_info.hpp"

namespace linescope {

RecordedCamera::RecordedCamera(std::filesystem::path folder) : folder_(std::move(folder)) {}

Result<void> RecordedCamera::start() {
  const auto info = read_recording_info(folder_);
  if (!info) return tl::unexpected(info.error());
  auto reader = RecordReader::open(folder_ / kPictureFile, RecordFileKind::pictures);
  if (!reader) return tl::unexpected(reader.error());
  camera_ = info->info.camera;
  period_ = info->info.camera_period;
  reader_.emplace(std::move(*reader));
  status_ = {};
  status_.state = CameraState::waiting;
  return {};
}

tl::unexpected<Error> RecordedCamera::damaged(const Error& error) {
  ++status_.counters.unreadable;
  return tl::unexpected(error);
}

Result<Pull> RecordedCamera::next_record() {
  if (!reader_) return fail(ErrorCode::usage, "the recording was not started");
  for (;;) {
    auto pull = reader_->next(record_);
    if (!pull) return damaged(pull.error());
    if (*pull == Pull::end) break;
    if (record_.type == static_cast<std::uint32_t>(RecordType::picture)) return Pull::item;
  }
  status_.state = CameraState::ended;
  status_.reason = fmt::format("{} pictures were read", status_.counters.delivered);
  if (reader_->unfinished_bytes() > 0) {
    status_.reason += "; the recording was cut off in the middle of the next one";
  }
  return Pull::end;
}

Result<Pull> RecordedCamera::next(Frame& frame) {
  const auto pull = next_record();
  if (!pull || *pull != Pull::item) return pull;
  if (const auto read = read_picture(record_, codec_, frame); !read) return damaged(read.error());
  ++status_.counters.delivered;
  status_.state = CameraState::ok;
  return Pull::item;
}

Result<Pull> RecordedCamera::next_head(PictureHead& head) {
  const auto pull = next_record();
  if (!pull || *pull != Pull::item) return pull;
  const auto read = read_picture_head(record_);
  if (!read) return damaged(read.error());
  head = *read;
  ++status_.counters.delivered;
  return Pull::item;
}

std::string RecordedCamera::description() const {
  return camera_.empty() ? fmt::format("recording {}", folder_.string())
                         : fmt::format("recording {} of {}", folder_.string(), camera_);
}

}  // namespace linescope
