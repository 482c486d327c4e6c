// The pictures of a recording as a camera.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "acquire/camera/camera_source.hpp"
#include "acquire/record/recorded_items.hpp"

namespace linescope {

/// Stepped. Gives the recorded pictures with their pixels, times, numbers and names to the last bit. Damage
/// is an error `unreadable`, counted, and the next call goes on behind it; a recording whose process was
/// killed ends with its last whole picture and says so in status().reason.
class RecordedCamera final : public CameraSource {
 public:
  explicit RecordedCamera(std::filesystem::path folder);

  Result<void> start() override;
  Result<Pull> next(Frame& frame) override;
  bool live() const override { return false; }
  std::string description() const override;
  CameraStatus status() const override { return status_; }
  Nanoseconds period() const override { return period_; }

  /// Skips pixels: time, number and size of the next picture only.
  Result<Pull> next_head(PictureHead& head);

 private:
  Result<Pull> next_record();
  tl::unexpected<Error> damaged(const Error& error);

  std::filesystem::path folder_;
  std::string camera_;  ///< what the recording calls its camera
  Nanoseconds period_ = 0;
  std::optional<RecordReader> reader_;
  Record record_;
  PictureCodec codec_;
  CameraStatus status_;
};

}  // namespace linescope
