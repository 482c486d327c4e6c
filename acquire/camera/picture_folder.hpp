// A folder of pictures as a camera: files in natural order (im2 before im10), times made up at a fixed rate.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "acquire/camera/camera_source.hpp"

namespace linescope {

struct PictureFolderOptions {
  std::filesystem::path folder = {};  ///< png, jpg, bmp, tif, pgm, ppm, webp; other files are passed over
  Nanoseconds start_time = 0;         ///< time of the first picture
  Nanoseconds period = 40 * kMillisecond;  ///< between two pictures
  int width = 0;                           ///< px expected; 0: the size of the first readable picture
  int height = 0;                          ///< px expected; 0: likewise
};

/// First fault of the options in one sentence.
Result<void> validate(const PictureFolderOptions& options);

/// A picture and the time it is given: what a list of poses by file name needs (see poses.csv in
/// docs/configuration.md).
struct TimedPicture {
  std::filesystem::path file;
  std::string name;  ///< file name without folder
  Nanoseconds time = 0;
};

/// The pictures of the folder in the order and with the times in which PictureFolder gives them. Unreadable
/// ones keep their place and their time. not_found: no such folder, or none in it.
Result<std::vector<TimedPicture>> list_pictures(const PictureFolderOptions& options);

/// Stepped source. A broken picture is `unreadable`, one of another size `mismatch`; both concern that
/// picture only.
class PictureFolder final : public CameraSource {
 public:
  explicit PictureFolder(PictureFolderOptions options);

  Result<void> start() override;
  Result<Pull> next(Frame& frame) override;
  bool live() const override { return false; }
  std::string description() const override;
  CameraStatus status() const override { return status_; }
  Nanoseconds period() const override { return options_.period; }

  /// After start(): the same list as list_pictures().
  const std::vector<TimedPicture>& pictures() const { return pictures_; }

 private:
  Result<void> check_size(const cv::Mat& picture, const std::string& name);
  Pull finish();

  PictureFolderOptions options_;
  std::vector<TimedPicture> pictures_;
  std::vector<unsigned char> buffer_;
  std::size_t position_ = 0;
  CameraStatus status_;
};

}  // namespace linescope
