#include "tools/calibrate/inputs.hpp"

#include <fmt/format.h>

#include "acquire/camera/picture_folder.hpp"
#include "acquire/camera/video_file.hpp"
#include "acquire/record/recorded_camera.hpp"
#include "acquire/record/recorded_tracker.hpp"
#include "acquire/record/recording.hpp"
#include "acquire/tracker/picture_pose_source.hpp"
#include "acquire/tracker/timed_pose_source.hpp"

namespace linescope::calibrate {
namespace {

namespace fs = std::filesystem;

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

Result<Input> from_recording(const fs::path& folder) {
  auto recording = open_recording(folder);
  if (!recording) return tl::unexpected(recording.error());
  Input input;
  input.camera = std::make_unique<RecordedCamera>(folder);
  input.tracker = std::make_unique<RecordedTracker>(folder);
  const RecordingInfo& info = recording->info;
  input.stations = {info.endoscope_station, info.object_station, info.harvester_station};
  input.calibration = info.calibration;
  input.description = fmt::format("recording {}", folder.filename().string());
  return input;
}

/// The folder's own list, or the one beside the folder.
fs::path pose_list_of(const fs::path& folder) {
  for (const fs::path& file : {folder / "poses.csv", folder.parent_path() / "poses.csv"})
    if (is_file(file)) return file;
  return {};
}

Result<Input> from_folder(const fs::path& given) {
  const fs::path folder = (given / "").parent_path();  // without a slash at its end
  const PictureFolderOptions options{.folder = folder};
  auto pictures = list_pictures(options);
  if (!pictures) return tl::unexpected(pictures.error());
  Input input;
  input.camera = std::make_unique<PictureFolder>(options);
  input.description = fmt::format("folder {}", folder.filename().string());
  const fs::path poses = pose_list_of(folder);
  if (poses.empty()) return input;
  std::vector<PictureInstant> instants;
  for (const TimedPicture& p : *pictures) instants.push_back({p.name, p.time});
  input.tracker = std::make_unique<PicturePoseSource>(
      poses, std::move(instants), PicturePoseOptions{.station = input.stations.endoscope});
  input.description += " with poses.csv";
  return input;
}

}  // namespace

Result<Input> input_from_path(const fs::path& path) {
  std::error_code ignored;
  if (!fs::exists(path, ignored))
    return fail(ErrorCode::not_found, fmt::format("{}: no such file or folder", path.string()));
  if (is_file(path / kInfoFile)) return from_recording(path);
  if (fs::is_directory(path, ignored)) return from_folder(path);
  Input input;
  input.description = fmt::format("file {}", path.filename().string());
  if (path.extension() == ".csv")
    input.tracker = std::make_unique<TimedPoseSource>(path, TimedPoseOptions{});
  else
    input.camera = std::make_unique<VideoFile>(VideoFileOptions{.file = path});
  return input;
}

}  // namespace linescope::calibrate
