// Pictures to few bytes without losing a bit: every row as its difference to the row above, then Zstandard.
//
// Chosen by measurement (docs/recording.md): about a fifth of the time of PNG or FFV1 at a size in between.
#pragma once

#include <cstdint>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <span>

#include "acquire/record/byte_codec.hpp"
#include "common/result.hpp"

namespace linescope {

/// How the pixels of a recorded picture are kept. The numbers stand in files.
enum class PictureEncoding : std::uint32_t {
  plain = 0,     ///< rows of blue, green, red bytes
  row_zstd = 1,  ///< difference to the row above (the first row as it is), all rows in one Zstandard frame
};

/// Keeps its working memory; one thread per codec.
class PictureCodec {
 public:
  PictureCodec();
  ~PictureCodec();
  PictureCodec(PictureCodec&&) noexcept;
  PictureCodec& operator=(PictureCodec&&) noexcept;

  /// Appends the picture's pixels to `out`. Precondition: `bgr` is CV_8UC3 and not empty; any stride.
  void encode(const cv::Mat& bgr, PictureEncoding encoding, Bytes& out);

  /// Fills `bgr` (memory used again where it fits) from what encode() appended. `unreadable` when the bytes
  /// do not give exactly width x height pixels.
  Result<void> decode(std::span<const std::uint8_t> bytes, PictureEncoding encoding, int width, int height,
                      cv::Mat& bgr);

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

}  // namespace linescope
