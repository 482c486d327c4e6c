// FNV-1a over everything a result was found from: tells whether two results come from the same data. Not
// meant against forgery.
#pragma once

#include <cstdint>
#include <cstring>
#include <opencv2/core/mat.hpp>

namespace linescope::calibrate {

class ContentHash {
 public:
  void add(const void* data, std::size_t bytes) {
    const auto* at = static_cast<const unsigned char*>(data);
    for (; bytes >= 8; bytes -= 8, at += 8) {
      std::uint64_t word = 0;
      std::memcpy(&word, at, 8);
      mix(word);
    }
    for (; bytes > 0; --bytes, ++at) mix(*at);
  }
  void add(const cv::Mat& picture) {
    for (int row = 0; row < picture.rows; ++row)
      add(picture.ptr(row), static_cast<std::size_t>(picture.cols) * picture.elemSize());
  }
  std::uint64_t value() const { return value_; }

 private:
  void mix(std::uint64_t word) {
    value_ = (value_ ^ word) * 0x100000001b3ULL;
    value_ ^= value_ >> 29;  // words, not bytes, are mixed in: the high half must reach the low one
  }
  std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

}  // namespace linescope::calibrate
