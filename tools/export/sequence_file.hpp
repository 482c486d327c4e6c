// Writes the sequence files of PLUS and 3D Slicer (.igs.mha, .seq.mha): a MetaImage whose header carries
// transforms, their status and times for every frame. docs/recording.md lists the fields.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "common/result.hpp"
#include "common/time.hpp"

namespace linescope {

/// One transform of one frame, named from and to ("HarvesterTipToWorld": tip coordinates in, world
/// coordinates out; mm).
struct SequenceTransform {
  std::string name;
  Eigen::Isometry3d to_from = Eigen::Isometry3d::Identity();
  bool valid = false;  ///< written as TransformStatus OK or INVALID; an invalid transform is the identity
};

struct SequenceFrame {
  Nanoseconds time = 0;      ///< corrected, on the poses' clock
  Nanoseconds raw_time = 0;  ///< as it was stamped: UnfilteredTimestamp
  std::uint64_t number = 0;
  bool has_picture = false;
  std::vector<SequenceTransform> transforms;
};

/// All frames first, then all pictures: the format puts the frames' fields before the pixels.
class SequenceFile {
 public:
  /// Width and height of the pictures; 1 x 1 with one channel when there are none.
  static Result<SequenceFile> create(const std::filesystem::path& file, int width, int height, bool colour);

  void add_frame(const SequenceFrame& frame);
  std::uint64_t frames() const { return frames_; }

  /// Ends the header; from here on only pictures.
  void end_frames();
  /// One per frame: `bgr` of the announced size, or an empty one for a frame without a picture (written
  /// black).
  void add_picture(const cv::Mat& bgr);

  /// `full` when not everything reached the file.
  Result<void> close();

 private:
  SequenceFile(std::filesystem::path file, int width, int height, bool colour);
  void write_header();

  std::filesystem::path file_;
  std::ofstream stream_;
  int width_;
  int height_;
  bool colour_;
  std::uint64_t frames_ = 0;
  std::streampos size_position_ = 0;
  cv::Mat rgb_;
};

}  // namespace linescope
