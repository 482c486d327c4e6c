// From light to the 8-bit picture: bloom, shot and read noise, saturation, chroma subsampling.
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "acquire/twin/optics_options.hpp"

namespace linescope::twin {

/// Grey levels per channel, row by row, before the sensor: may exceed 255.
struct LightImage {
  int width = 0, height = 0;
  std::vector<std::array<float, 3>> bgr;

  void clear(int new_width, int new_height) {
    width = new_width;
    height = new_height;
    bgr.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), {0, 0, 0});
  }
  std::array<float, 3>& at(int u, int v) { return bgr[static_cast<std::size_t>(v * width + u)]; }
  const std::array<float, 3>& at(int u, int v) const { return bgr[static_cast<std::size_t>(v * width + u)]; }
};

class ImageSensor {
 public:
  ImageSensor(std::uint64_t seed, const SensorOptions& options);

  /// Writes CV_8UC3 of the light's size. `light` is changed (bloom). The noise depends on seed and picture
  /// index alone.
  void expose(LightImage& light, std::uint64_t index, cv::Mat& bgr) const;

 private:
  void bloom(LightImage& light) const;
  void expose_row(const LightImage& light, int v, std::uint64_t index, std::uint8_t* out) const;

  std::uint64_t seed_;
  SensorOptions options_;
  std::vector<float> normal_table_;
};

}  // namespace linescope::twin
