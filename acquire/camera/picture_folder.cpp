#include "acquire/camera/picture_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "acquire/camera/natural_order.hpp"
#include "acquire/camera/picture_file.hpp"

namespace linescope {
namespace {

namespace fs = std::filesystem;

Result<void> check_folder(const fs::path& folder) {
  std::error_code error;
  const fs::file_status status = fs::status(folder, error);
  if (!fs::exists(status)) {
    return fail(ErrorCode::not_found,
                fmt::format("there is no folder {}; check the path of the pictures", folder.string()));
  }
  if (fs::is_directory(status)) return {};
  return fail(ErrorCode::usage,
              fmt::format("{} is not a folder; name the folder that holds the pictures", folder.string()));
}

Result<std::vector<fs::path>> picture_files(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> files;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    if (looks_like_picture(entry->path()) && !entry->is_directory(error)) files.push_back(entry->path());
  }
  if (error) {
    return fail(ErrorCode::permission, fmt::format("folder {} cannot be listed: {}; check its permissions",
                                                   folder.string(), error.message()));
  }
  std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
    return natural_less(a.filename().native(), b.filename().native());
  });
  return files;
}

}  // namespace

Result<void> validate(const PictureFolderOptions& options) {
  if (options.folder.empty()) return fail(ErrorCode::usage, "no folder of pictures is named");
  if (options.period <= 0) {
    return fail(ErrorCode::invalid, fmt::format("the time between two pictures must be above 0, it is {} ms",
                                                milliseconds_from(options.period)));
  }
  if (options.width < 0 || options.height < 0 || (options.width == 0) != (options.height == 0)) {
    return fail(ErrorCode::invalid,
                fmt::format("an expected picture size of {}x{} px makes no sense; give both or none",
                            options.width, options.height));
  }
  return {};
}

Result<std::vector<TimedPicture>> list_pictures(const PictureFolderOptions& options) {
  if (auto valid = validate(options); !valid) return tl::unexpected(valid.error());
  if (auto there = check_folder(options.folder); !there) return tl::unexpected(there.error());
  const auto files = picture_files(options.folder);
  if (!files) return tl::unexpected(files.error());
  if (files->empty()) {
    return fail(
        ErrorCode::not_found,
        fmt::format("folder {} holds no pictures (png, jpg, bmp, tif, pgm, ppm, webp); name another folder",
                    options.folder.string()));
  }
  std::vector<TimedPicture> pictures;
  pictures.reserve(files->size());
  for (const fs::path& file : *files) {
    const auto i = static_cast<Nanoseconds>(pictures.size());
    pictures.push_back({file, file.filename().string(), options.start_time + i * options.period});
  }
  return pictures;
}

PictureFolder::PictureFolder(PictureFolderOptions options) : options_(std::move(options)) {}

Result<void> PictureFolder::start() {
  auto pictures = list_pictures(options_);
  if (!pictures) return tl::unexpected(pictures.error());
  pictures_ = std::move(*pictures);
  position_ = 0;
  status_ = {};
  status_.state = CameraState::waiting;
  return {};
}

Result<void> PictureFolder::check_size(const cv::Mat& picture, const std::string& name) {
  if (options_.width == 0) {
    options_.width = picture.cols;
    options_.height = picture.rows;
  }
  if (picture.cols == options_.width && picture.rows == options_.height) return {};
  return fail(ErrorCode::mismatch,
              fmt::format("picture {} is {}x{} px where {}x{} px is expected; it is passed over", name,
                          picture.cols, picture.rows, options_.width, options_.height));
}

Result<Pull> PictureFolder::next(Frame& frame) {
  if (status_.state == CameraState::not_started) return fail(ErrorCode::usage, "the folder was not started");
  if (position_ == pictures_.size()) return finish();
  const std::uint64_t index = position_++;
  const TimedPicture& entry = pictures_[index];
  auto picture = read_picture(entry.file, buffer_);
  if (!picture) {
    ++status_.counters.unreadable;
    return tl::unexpected(picture.error());
  }
  if (auto fits = check_size(*picture, entry.name); !fits) {
    ++status_.counters.mismatched;
    return tl::unexpected(fits.error());
  }
  frame = {std::move(*picture), entry.time, index, entry.name};
  ++status_.counters.delivered;
  status_.state = CameraState::ok;
  return Pull::item;
}

Pull PictureFolder::finish() {
  status_.state = CameraState::ended;
  status_.reason = fmt::format("{} of {} pictures were used", status_.counters.delivered, pictures_.size());
  return Pull::end;
}

std::string PictureFolder::description() const {
  if (pictures_.empty()) return fmt::format("folder {}", options_.folder.string());
  return fmt::format("folder {}, {} pictures", options_.folder.string(), pictures_.size());
}

}  // namespace linescope
