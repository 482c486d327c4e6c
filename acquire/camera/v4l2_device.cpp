#include "acquire/camera/v4l2_device.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <utility>

namespace linescope {
namespace {

constexpr std::int64_t kReadWait = 50 * kMillisecond;

/// V4L2_CID_EXPOSURE_ABSOLUTE counts in 100 microseconds.
constexpr double kExposureUnitsPerMillisecond = 10;

/// V4L2_CID_EXPOSURE_AUTO: UVC cameras know "manual" and "aperture priority" as off and on.
constexpr double kExposureManual = 1;
constexpr double kExposureAutomatic = 3;

double fourcc_code(const std::string& text) {
  return cv::VideoWriter::fourcc(text[0], text[1], text[2], text[3]);
}

std::string fourcc_text(double code) {
  const auto bits = static_cast<std::uint32_t>(std::max(code, 0.0));
  std::string text;
  for (int shift = 0; shift < 32; shift += 8) {
    const char c = static_cast<char>(bits >> shift & 0xFFU);
    text += c >= 0x20 && c < 0x7F ? c : '?';
  }
  return text;
}

class V4l2Device final : public CaptureDevice {
 public:
  explicit V4l2Device(V4l2Options options) : options_(std::move(options)) {}

  Result<OpenedDevice> open() override;
  void close() override { camera().release(); }
  Result<Pull> read(cv::Mat& bgr, Nanoseconds& stamp) override;
  Result<void> set_exposure(double milliseconds) override;
  Result<void> set_gain(double gain) override;
  double exposure_ms() const override { return exposure_ms_; }

 private:
  /// In a vector, because that is how OpenCV waits with a time limit.
  cv::VideoCapture& camera() { return streams_.front(); }

  Result<CameraInfo> find() const;
  Result<void> open_node(const CameraInfo& info);
  OpenedDevice configure();
  void configure_picture(std::vector<std::string>& remarks);
  void configure_colour(std::vector<std::string>& remarks);
  Result<void> lock_white_balance();
  Result<void> set_control(int property, double value, double unit, std::string_view what);
  bool wait_for_picture();
  Result<Pull> retrieve(cv::Mat& bgr);

  V4l2Options options_;
  CameraInfo info_;         ///< of the camera once it was opened
  double exposure_ms_ = 0;  ///< as the camera has it; 0: it sets it itself
  std::vector<cv::VideoCapture> streams_ = std::vector<cv::VideoCapture>(1);
  std::vector<int> ready_;
  cv::Mat raw_;
};

Result<CameraInfo> V4l2Device::find() const {
  const std::vector<CameraInfo> cameras = list_cameras();
  if (info_.path.empty()) return choose_camera(options_.device, cameras);
  for (const CameraInfo& camera : cameras) {
    if (camera.name == info_.name && camera.usable()) return camera;
  }
  return fail(ErrorCode::gone,
              fmt::format("camera {} ({}) is unplugged; plug it in again", info_.path, info_.name));
}

Result<void> V4l2Device::open_node(const CameraInfo& info) {
  try {
    if (camera().open(info.path, cv::CAP_V4L2)) return {};
  } catch (const cv::Exception&) {
    // Told below, as every other failure to open.
  }
  return fail(
      ErrorCode::unreadable,
      fmt::format("camera {} ({}) does not start; unplug it and plug it in again", info.path, info.name));
}

Result<OpenedDevice> V4l2Device::open() {
  if (auto valid = validate(options_); !valid) return tl::unexpected(valid.error());
  const auto info = find();
  if (!info) return tl::unexpected(info.error());
  if (auto node = open_node(*info); !node) return tl::unexpected(node.error());
  info_ = *info;
  try {
    return configure();
  } catch (const cv::Exception& error) {
    close();
    return fail(ErrorCode::gone,
                fmt::format("camera {} went away while it was set up: {}", info_.path, error.err));
  }
}

OpenedDevice V4l2Device::configure() {
  OpenedDevice result;
  configure_picture(result.remarks);
  configure_colour(result.remarks);
  const double rate = camera().get(cv::CAP_PROP_FPS);
  result.period = rate > 0 ? std::llround(1e9 / rate) : 0;
  result.description =
      fmt::format("{} ({}), {:.0f}x{:.0f} px at {:.4g} Hz, {}", info_.path, info_.name,
                  camera().get(cv::CAP_PROP_FRAME_WIDTH), camera().get(cv::CAP_PROP_FRAME_HEIGHT), rate,
                  fourcc_text(camera().get(cv::CAP_PROP_FOURCC)));
  return result;
}

void V4l2Device::configure_picture(std::vector<std::string>& remarks) {
  if (!options_.pixel_format.empty()) camera().set(cv::CAP_PROP_FOURCC, fourcc_code(options_.pixel_format));
  camera().set(cv::CAP_PROP_FRAME_WIDTH, options_.width);
  camera().set(cv::CAP_PROP_FRAME_HEIGHT, options_.height);
  camera().set(cv::CAP_PROP_FPS, options_.rate_hz);

  const double width = camera().get(cv::CAP_PROP_FRAME_WIDTH),
               height = camera().get(cv::CAP_PROP_FRAME_HEIGHT);
  if (width != options_.width || height != options_.height) {
    remarks.push_back(fmt::format("{}x{} px were asked, the camera gives {:.0f}x{:.0f} px", options_.width,
                                  options_.height, width, height));
  }
  if (const double rate = camera().get(cv::CAP_PROP_FPS);
      std::abs(rate - options_.rate_hz) > 0.01 * options_.rate_hz) {
    remarks.push_back(fmt::format("{} Hz were asked, the camera gives {:.4g} Hz", options_.rate_hz, rate));
  }
  const std::string format = fourcc_text(camera().get(cv::CAP_PROP_FOURCC));
  if (!options_.pixel_format.empty() && format != options_.pixel_format) {
    remarks.push_back(
        fmt::format("pixel format {} was asked, the camera gives {}", options_.pixel_format, format));
  }
}

void V4l2Device::configure_colour(std::vector<std::string>& remarks) {
  const auto note = [&remarks](const Result<void>& result) {
    if (!result) remarks.push_back(result.error().message);
  };
  if (options_.exposure_ms > 0) {
    note(set_exposure(options_.exposure_ms));
  } else {
    camera().set(cv::CAP_PROP_AUTO_EXPOSURE, kExposureAutomatic);
    exposure_ms_ = 0;
  }
  if (options_.gain >= 0) note(set_gain(options_.gain));
  if (options_.white_balance_k >= 0) note(lock_white_balance());
}

/// A white balance that follows the picture turns the laser's colour with it. Cameras without the control
/// have nothing to lock.
Result<void> V4l2Device::lock_white_balance() {
  camera().set(cv::CAP_PROP_AUTO_WB, 0);
  if (camera().get(cv::CAP_PROP_AUTO_WB) > 0)
    return fail(ErrorCode::unsupported, "the camera's automatic white balance cannot be switched off");
  if (options_.white_balance_k == 0) return {};
  return set_control(cv::CAP_PROP_WB_TEMPERATURE, options_.white_balance_k, 1, "white balance (K)");
}

Result<void> V4l2Device::set_control(int property, double value, double unit, std::string_view what) {
  const double wanted = std::round(value * unit);
  const bool taken = camera().set(property, wanted);
  const double got = camera().get(property);
  if (taken && std::abs(got - wanted) < 1) return {};
  if (got < 0) return fail(ErrorCode::unsupported, fmt::format("the camera has no control for {}", what));
  return fail(ErrorCode::invalid,
              fmt::format("{} {:.6g} was asked, the camera has {:.6g}", what, value, got / unit));
}

Result<void> V4l2Device::set_exposure(double milliseconds) try {
  options_.exposure_ms = milliseconds;
  camera().set(cv::CAP_PROP_AUTO_EXPOSURE, kExposureManual);
  auto set = set_control(cv::CAP_PROP_EXPOSURE, milliseconds, kExposureUnitsPerMillisecond, "exposure (ms)");
  exposure_ms_ = std::max(camera().get(cv::CAP_PROP_EXPOSURE), 0.0) / kExposureUnitsPerMillisecond;
  return set;
} catch (const cv::Exception& error) {
  return fail(ErrorCode::gone, error.err);
}

Result<void> V4l2Device::set_gain(double gain) try {
  options_.gain = gain;
  return set_control(cv::CAP_PROP_GAIN, gain, 1, "gain");
} catch (const cv::Exception& error) {
  return fail(ErrorCode::gone, error.err);
}

bool V4l2Device::wait_for_picture() {
  ready_.clear();
  return cv::VideoCapture::waitAny(streams_, ready_, kReadWait);
}

Result<Pull> V4l2Device::retrieve(cv::Mat& bgr) {
  if (!camera().retrieve(raw_) || raw_.empty()) {
    return fail(ErrorCode::unreadable,
                fmt::format("a picture of {} is broken; it is passed over", info_.path));
  }
  if (raw_.type() == CV_8UC3) {
    raw_.copyTo(bgr);
  } else if (raw_.type() == CV_8UC1) {
    cv::cvtColor(raw_, bgr, cv::COLOR_GRAY2BGR);
  } else {
    return fail(ErrorCode::unsupported,
                fmt::format("camera {} gives pictures of {} channels; choose another pixel format",
                            info_.path, raw_.channels()));
  }
  return Pull::item;
}

Result<Pull> V4l2Device::read(cv::Mat& bgr, Nanoseconds& stamp) try {
  if (!wait_for_picture()) return Pull::nothing_yet;
  if (!camera().grab()) {
    return fail(ErrorCode::gone, fmt::format("camera {} ({}) was unplugged", info_.path, info_.name));
  }
  stamp = std::llround(camera().get(cv::CAP_PROP_POS_MSEC) * 1e6);
  return retrieve(bgr);
} catch (const cv::Exception& error) {
  return fail(ErrorCode::gone, fmt::format("camera {} ({}) stopped: {}", info_.path, info_.name, error.err));
}

}  // namespace

Result<void> validate(const V4l2Options& options) {
  if (options.width < 16 || options.height < 16 || options.width > 16384 || options.height > 16384) {
    return fail(ErrorCode::invalid, fmt::format("a picture size of {}x{} px is not between 16 and 16384 px",
                                                options.width, options.height));
  }
  if (!(options.rate_hz > 0 && options.rate_hz <= 1000)) {
    return fail(ErrorCode::invalid,
                fmt::format("a rate of {} Hz is not between 0 and 1000 Hz", options.rate_hz));
  }
  if (!options.pixel_format.empty() && options.pixel_format.size() != 4) {
    return fail(ErrorCode::invalid,
                fmt::format("pixel format \"{}\" must have four characters, for example MJPG or YUYV",
                            options.pixel_format));
  }
  if (!(options.exposure_ms >= 0 && options.exposure_ms <= 10'000)) {
    return fail(
        ErrorCode::invalid,
        fmt::format("an exposure of {} ms is not between 0 (automatic) and 10000 ms", options.exposure_ms));
  }
  const bool locked = options.white_balance_k >= 1000 && options.white_balance_k <= 20'000;
  if (options.white_balance_k != 0 && options.white_balance_k != -1 && !locked) {
    return fail(ErrorCode::invalid,
                fmt::format("a white balance of {} K is neither -1 (automatic), 0 (locked as it is) nor "
                            "between 1000 and 20000 K",
                            options.white_balance_k));
  }
  return {};
}

std::unique_ptr<CaptureDevice> make_v4l2_device(const V4l2Options& options) {
  return std::make_unique<V4l2Device>(options);
}

}  // namespace linescope
