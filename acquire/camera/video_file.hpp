// A video file as a camera (everything that OpenCV's FFmpeg backend reads).
#pragma once

#include <filesystem>
#include <opencv2/videoio.hpp>
#include <string>

#include "acquire/camera/camera_source.hpp"

namespace linescope {

struct VideoFileOptions {
  std::filesystem::path file = {};
  Nanoseconds start_time = 0;  ///< time of the first picture
  Nanoseconds period = 0;      ///< between two pictures; 0: the time stamps of the file
  int width = 0;               ///< px expected; 0: whatever the file has
  int height = 0;              ///< px expected; 0: likewise
};

/// First fault of the options in one sentence.
Result<void> validate(const VideoFileOptions& options);

/// Stepped source. Times never go back: a file whose time stamps do is read at its nominal rate from there
/// on, and a remark in status() says so. A file that ends before its announced length says it in
/// status().reason.
class VideoFile final : public CameraSource {
 public:
  explicit VideoFile(VideoFileOptions options);

  Result<void> start() override;
  Result<Pull> next(Frame& frame) override;
  bool live() const override { return false; }
  std::string description() const override;
  CameraStatus status() const override { return status_; }
  Nanoseconds period() const override { return period_; }

 private:
  Nanoseconds time_of_current();
  Pull finish();

  VideoFileOptions options_;
  cv::VideoCapture capture_;
  Nanoseconds period_ = 0;
  Nanoseconds last_time_ = 0;
  bool stamps_usable_ = true;
  std::uint64_t position_ = 0;
  double announced_ = 0;  ///< pictures, by the file's header; <= 0 when it does not say
  CameraStatus status_;
};

}  // namespace linescope
