#include "acquire/record/picture_codec.hpp"

#include <fmt/format.h>
#include <zstd.h>

#include <cstring>
#include <limits>

namespace linescope {
namespace {

/// Level 1: on one core it keeps up with 640x480 at 100 Hz; higher levels gain a few per cent for twice the
/// time.
constexpr int kLevel = 1;

std::size_t row_bytes(const cv::Mat& bgr) {
  return static_cast<std::size_t>(bgr.cols) * 3;
}

void copy_rows(const cv::Mat& bgr, std::uint8_t* out) {
  for (int y = 0; y < bgr.rows; ++y, out += row_bytes(bgr)) std::memcpy(out, bgr.ptr(y), row_bytes(bgr));
}

/// Modulo 256, so that decoding is exact.
void subtract_rows(const cv::Mat& bgr, std::uint8_t* out) {
  const std::size_t size = row_bytes(bgr);
  std::memcpy(out, bgr.ptr(0), size);
  for (int y = 1; y < bgr.rows; ++y) {
    out += size;
    const std::uint8_t* row = bgr.ptr(y);
    const std::uint8_t* above = bgr.ptr(y - 1);
    for (std::size_t i = 0; i < size; ++i) out[i] = static_cast<std::uint8_t>(row[i] - above[i]);
  }
}

/// `bgr` is continuous here: it was created by decode().
void add_rows(cv::Mat& bgr) {
  const std::size_t size = row_bytes(bgr);
  for (int y = 1; y < bgr.rows; ++y) {
    std::uint8_t* row = bgr.ptr(y);
    const std::uint8_t* above = bgr.ptr(y - 1);
    for (std::size_t i = 0; i < size; ++i) row[i] = static_cast<std::uint8_t>(row[i] + above[i]);
  }
}

}  // namespace

struct PictureCodec::Work {
  ZSTD_CCtx* compressor = ZSTD_createCCtx();
  ZSTD_DCtx* decompressor = ZSTD_createDCtx();
  Bytes differences;

  Work() = default;
  Work(const Work&) = delete;
  Work& operator=(const Work&) = delete;
  ~Work() {
    ZSTD_freeCCtx(compressor);
    ZSTD_freeDCtx(decompressor);
  }
};

PictureCodec::PictureCodec() : work_(std::make_unique<Work>()) {}
PictureCodec::~PictureCodec() = default;
PictureCodec::PictureCodec(PictureCodec&&) noexcept = default;
PictureCodec& PictureCodec::operator=(PictureCodec&&) noexcept = default;

void PictureCodec::encode(const cv::Mat& bgr, PictureEncoding encoding, Bytes& out) {
  const std::size_t pixels = row_bytes(bgr) * static_cast<std::size_t>(bgr.rows), before = out.size();
  if (encoding == PictureEncoding::plain) {
    out.resize(before + pixels);
    return copy_rows(bgr, out.data() + before);
  }
  work_->differences.resize(pixels);
  subtract_rows(bgr, work_->differences.data());
  out.resize(before + ZSTD_compressBound(pixels));
  const std::size_t size = ZSTD_compressCCtx(work_->compressor, out.data() + before, out.size() - before,
                                             work_->differences.data(), pixels, kLevel);
  out.resize(before + size);
}

Result<void> PictureCodec::decode(std::span<const std::uint8_t> bytes, PictureEncoding encoding, int width,
                                  int height, cv::Mat& bgr) {
  if (!bgr.isContinuous()) bgr.release();
  bgr.create(height, width, CV_8UC3);
  const std::size_t pixels = row_bytes(bgr) * static_cast<std::size_t>(height);
  if (encoding == PictureEncoding::plain && bytes.size() == pixels) {
    std::memcpy(bgr.data, bytes.data(), pixels);
    return {};
  }
  if (encoding == PictureEncoding::row_zstd &&
      ZSTD_decompressDCtx(work_->decompressor, bgr.data, pixels, bytes.data(), bytes.size()) == pixels) {
    add_rows(bgr);
    return {};
  }
  return fail(ErrorCode::unreadable,
              fmt::format("{} bytes do not give a picture of {}x{} px", bytes.size(), width, height));
}

}  // namespace linescope
