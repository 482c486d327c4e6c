#include "tools/export/sequence_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "tools/export/seconds_text.hpp"

namespace linescope {
namespace {

/// Row by row, as the format wants it; 17 digits keep every bit.
std::string numbers_of(const Eigen::Isometry3d& transform) {
  std::string text;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) text += fmt::format("{:.17g} ", transform(row, column));
  }
  text.pop_back();
  return text;
}

}  // namespace

SequenceFile::SequenceFile(std::filesystem::path file, int width, int height, bool colour)
    : file_(std::move(file)),
      stream_(file_, std::ios::binary | std::ios::trunc),
      width_(width),
      height_(height),
      colour_(colour) {}

Result<SequenceFile> SequenceFile::create(const std::filesystem::path& file, int width, int height,
                                          bool colour) {
  SequenceFile sequence(file, width, height, colour);
  if (!sequence.stream_) {
    return fail(ErrorCode::permission,
                fmt::format("{} cannot be written: {}", file.string(), std::strerror(errno)));
  }
  sequence.write_header();
  return sequence;
}

void SequenceFile::write_header() {
  stream_ << "ObjectType = Image\nNDims = 3\nAnatomicalOrientation = RAI\nBinaryData = True\n"
             "BinaryDataByteOrderMSB = False\nCenterOfRotation = 0 0 0\nCompressedData = False\n";
  size_position_ = stream_.tellp();
  stream_ << fmt::format("{:<64}\n", "DimSize = ");
  stream_ << "Kinds = domain domain list\nElementSpacing = 1 1 1\nElementType = MET_UCHAR\n";
  if (colour_) stream_ << "ElementNumberOfChannels = 3\nUltrasoundImageType = RGB_COLOR\n";
  stream_ << "Offset = 0 0 0\nTransformMatrix = 1 0 0 0 1 0 0 0 1\nUltrasoundImageOrientation = MFA\n";
}

void SequenceFile::add_frame(const SequenceFrame& frame) {
  const std::string prefix = fmt::format("Seq_Frame{:04}_", frames_++);
  const auto field = [&](std::string_view name, const std::string& value) {
    stream_ << prefix << name << " = " << value << '\n';
  };
  field("FrameNumber", std::to_string(frame.number));
  for (const SequenceTransform& transform : frame.transforms) {
    field(transform.name + "Transform",
          numbers_of(transform.valid ? transform.to_from : Eigen::Isometry3d::Identity()));
    field(transform.name + "TransformStatus", transform.valid ? "OK" : "INVALID");
  }
  field("Timestamp", seconds_text(frame.time));
  field("UnfilteredTimestamp", seconds_text(frame.raw_time));
  field("ImageStatus", frame.has_picture ? "OK" : "INVALID");
}

void SequenceFile::end_frames() {
  stream_ << "ElementDataFile = LOCAL\n";
  const std::streampos data = stream_.tellp();
  stream_.seekp(size_position_);
  stream_ << fmt::format("DimSize = {} {} {}", width_, height_, frames_);
  stream_.seekp(data);
}

void SequenceFile::add_picture(const cv::Mat& bgr) {
  const bool fits = bgr.cols == width_ && bgr.rows == height_ && bgr.type() == CV_8UC3;
  if (fits && colour_) {
    cv::cvtColor(bgr, rgb_, cv::COLOR_BGR2RGB);
  } else {
    rgb_ = cv::Mat::zeros(height_, width_, colour_ ? CV_8UC3 : CV_8UC1);
  }
  stream_.write(reinterpret_cast<const char*>(rgb_.data),
                static_cast<std::streamsize>(rgb_.total() * rgb_.elemSize()));
}

Result<void> SequenceFile::close() {
  stream_.close();
  if (stream_) return {};
  return fail(ErrorCode::full,
              fmt::format("{} could not be written completely; is the disk full?", file_.string()));
}

}  // namespace linescope
