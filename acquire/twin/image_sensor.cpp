#include "acquire/twin/image_sensor.hpp"

#include <algorithm>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>

#include "acquire/twin/dice.hpp"

namespace linescope::twin {
namespace {

constexpr std::size_t kTableBits = 12;
constexpr std::size_t kTableSize = std::size_t{1} << kTableBits;
constexpr float kFull = 255.0F;

// Normal deviates at equal steps of probability: a random index gives a normal number at the price of one
// look-up.
std::vector<float> normal_quantiles() {
  std::vector<float> table(kTableSize);
  for (std::size_t i = 0; i < kTableSize; ++i) {
    const double p = (static_cast<double>(i) + 0.5) / static_cast<double>(kTableSize);
    table[i] = static_cast<float>(std::sqrt(2.0) * boost::math::erf_inv(2 * p - 1));
  }
  return table;
}

// Rounds numbers above -512; std::nearbyint is a call into the library on plain x86-64.
float whole(float v) {
  return static_cast<float>(static_cast<int>(v + 512.5F) - 512);
}

std::uint8_t to_byte(float level) {
  return static_cast<std::uint8_t>(std::clamp(level, 0.0F, kFull) + 0.5F);
}

struct YCbCr {
  float y, cb, cr;
};

// Full-range BT.601, what UVC cameras send as YUYV or JPEG.
YCbCr coded(const std::array<float, 3>& bgr) {
  const float y = 0.114F * bgr[0] + 0.587F * bgr[1] + 0.299F * bgr[2];
  return {y, 0.564F * (bgr[0] - y), 0.713F * (bgr[2] - y)};
}

void decode(float y, float cb, float cr, std::uint8_t* out) {
  out[0] = to_byte(y + 1.772F * cb);
  out[1] = to_byte(y - 0.344F * cb - 0.714F * cr);
  out[2] = to_byte(y + 1.402F * cr);
}

// Two neighbours share one chroma value; all numbers are sent as whole ones.
void subsample(const std::array<float, 3>& left, const std::array<float, 3>& right, std::uint8_t* out) {
  const YCbCr a = coded(left), b = coded(right);
  const float cb = whole(0.5F * (a.cb + b.cb)), cr = whole(0.5F * (a.cr + b.cr));
  decode(whole(a.y), cb, cr, out);
  decode(whole(b.y), cb, cr, out + 3);
}

}  // namespace

ImageSensor::ImageSensor(std::uint64_t seed, const SensorOptions& options)
    : seed_(seed), options_(options), normal_table_(normal_quantiles()) {}

// What a full pixel cannot hold spills to its neighbours along the column, once.
void ImageSensor::bloom(LightImage& light) const {
  const auto share = static_cast<float>(options_.bloom);
  if (!(share > 0)) return;
  for (int v = 1; v + 1 < light.height; ++v) {
    for (int u = 0; u < light.width; ++u) {
      for (std::size_t c = 0; c < 3; ++c) {
        const float spill = share * (light.at(u, v)[c] - kFull);
        if (!(spill > 0)) continue;
        light.at(u, v - 1)[c] += spill;
        light.at(u, v + 1)[c] += spill;
        light.at(u, v)[c] -= 2 * spill;
      }
    }
  }
}

void ImageSensor::expose_row(const LightImage& light, int v, std::uint64_t index, std::uint8_t* out) const {
  Dice dice(seed_, Stream::pixels, index * 65536 + static_cast<std::uint64_t>(v));
  const auto read_variance = static_cast<float>(options_.read_noise * options_.read_noise);
  const float shot =
      options_.electrons_per_level > 0 ? static_cast<float>(1 / options_.electrons_per_level) : 0.0F;
  const bool noisy = read_variance > 0 || shot > 0;
  std::array<std::array<float, 3>, 2> pair{};
  for (int u = 0; u < light.width; ++u) {
    std::array<float, 3>& pixel = pair[static_cast<std::size_t>(u & 1)];
    pixel = light.at(u, v);
    std::uint64_t bits = noisy ? dice.bits() : 0;
    for (std::size_t c = 0; c < 3; ++c, bits >>= 16) {
      if (noisy)
        pixel[c] += std::sqrt(read_variance + shot * pixel[c]) * normal_table_[bits & (kTableSize - 1)];
      pixel[c] = std::clamp(pixel[c], 0.0F, kFull);
    }
    if (!options_.chroma_subsampling || (u + 1 == light.width && (u & 1) == 0)) {
      for (std::size_t c = 0; c < 3; ++c) out[3 * u + static_cast<int>(c)] = to_byte(pixel[c]);
    } else if ((u & 1) == 1) {
      subsample(pair[0], pair[1], out + 3 * (u - 1));
    }
  }
}

void ImageSensor::expose(LightImage& light, std::uint64_t index, cv::Mat& bgr) const {
  bgr.create(light.height, light.width, CV_8UC3);
  bloom(light);
  for (int v = 0; v < light.height; ++v) expose_row(light, v, index, bgr.ptr<std::uint8_t>(v));
}

}  // namespace linescope::twin
