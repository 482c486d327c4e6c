#include "acquire/camera/camera_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "acquire/camera/device_camera.hpp"
#include "acquire/camera/picture_file.hpp"
#include "acquire/camera/picture_folder.hpp"
#include "acquire/camera/video_file.hpp"

namespace linescope {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 8> kVideoEndings{".mkv", ".avi",  ".mp4", ".mov",
                                                        ".m4v", ".webm", ".mpg", ".ts"};

/// "frames/", "scan.mkv": meant as a file. Names of cameras hold points, too ("USB2.0 Camera").
bool looks_like_path(const std::string& source) {
  const std::string ending = fs::path(source).extension().string();
  return source.find('/') != std::string::npos || looks_like_picture(source) ||
         std::find(kVideoEndings.begin(), kVideoEndings.end(), ending) != kVideoEndings.end();
}

template <class Source, class Options>
Result<std::unique_ptr<CameraSource>> checked(const Options& options) {
  if (auto valid = validate(options); !valid) return tl::unexpected(valid.error());
  return std::make_unique<Source>(options);
}

Result<std::unique_ptr<CameraSource>> device(const CameraOptions& options) {
  V4l2Options asked = options.device;
  asked.device = options.source;
  if (auto valid = validate(asked); !valid) return tl::unexpected(valid.error());
  return std::make_unique<DeviceCamera>(make_v4l2_device(asked));
}

Result<std::unique_ptr<CameraSource>> folder(const CameraOptions& options) {
  PictureFolderOptions asked{options.source, options.start_time, {}, options.width, options.height};
  asked.period = options.period != 0 ? options.period : PictureFolderOptions{}.period;
  return checked<PictureFolder>(asked);
}

Result<std::unique_ptr<CameraSource>> video(const CameraOptions& options) {
  return checked<VideoFile>(
      VideoFileOptions{options.source, options.start_time, options.period, options.width, options.height});
}

}  // namespace

Result<CameraKind> kind_of_camera(const std::string& source) {
  std::error_code ignored;
  const fs::file_status status = fs::status(source, ignored);
  if (fs::is_directory(status)) return CameraKind::folder;
  if (source.rfind("/dev/", 0) == 0) return CameraKind::device;
  if (fs::is_regular_file(status) && looks_like_picture(source)) {
    return fail(ErrorCode::usage,
                fmt::format("{} is a single picture; name the folder that holds the pictures", source));
  }
  if (fs::exists(status)) return CameraKind::video;
  if (looks_like_path(source)) {
    return fail(
        ErrorCode::not_found,
        fmt::format("there is no file or folder {}; check the path, or name a camera (--list shows them)",
                    source));
  }
  return CameraKind::device;
}

Result<std::unique_ptr<CameraSource>> make_camera(const CameraOptions& options) {
  const auto kind = kind_of_camera(options.source);
  if (!kind) return tl::unexpected(kind.error());
  switch (*kind) {
    case CameraKind::folder:
      return folder(options);
    case CameraKind::video:
      return video(options);
    case CameraKind::device:
      break;
  }
  return device(options);
}

}  // namespace linescope
