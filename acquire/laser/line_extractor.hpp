// From a picture to the laser line: colour says where the line is, intensity says where its middle is
// (docs/extraction.md).
//
//   LineExtractor extractor(options);
//   const ExtractedLine& line = extractor.extract(frame.bgr);
#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>

#include "acquire/laser/extracted_line.hpp"
#include "acquire/laser/line_extractor_options.hpp"

namespace linescope {

/// Keeps its working memory from picture to picture: once it has seen the busiest picture of a size nothing
/// is allocated. One thread per extractor; the result of a picture does not depend on the pictures before it.
class LineExtractor {
 public:
  /// Precondition: validate(options) holds.
  explicit LineExtractor(const LineExtractorOptions& options);
  ~LineExtractor();
  LineExtractor(LineExtractor&&) noexcept;
  LineExtractor& operator=(LineExtractor&&) noexcept;

  /// `picture`: 8-bit BGR or 8-bit grey, 16x16 to 16384x16384, any stride. Anything else gives an empty line,
  /// all of whose profiles are counted as NoPoint::bad_picture (one for an empty picture). Good until the
  /// next call.
  const ExtractedLine& extract(const cv::Mat& picture);

  const LineExtractorOptions& options() const;

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

}  // namespace linescope
