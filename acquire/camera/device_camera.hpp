// A camera at this machine as a live source: its own capture thread, unplug and replug, nothing lost in
// silence.
#pragma once

#include <array>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "acquire/camera/camera_source.hpp"
#include "acquire/camera/capture_device.hpp"

namespace linescope {

/// How the live source behaves in time; the defaults are right outside of tests.
struct DeviceCameraTiming {
  Nanoseconds longest_wait = 50 * kMillisecond;      ///< next() says nothing_yet after it
  Nanoseconds reconnect_every = 500 * kMillisecond;  ///< between two attempts to find a lost camera again
  Nanoseconds silence_limit = 2 * kSecond;  ///< an open camera without a picture for so long is opened anew
  std::function<Nanoseconds()> now = monotonic_now;  ///< CLOCK_MONOTONIC
};

/// Live source over a CaptureDevice.
///
/// The capture thread reads as fast as the camera delivers and keeps the newest kQueue pictures; when nobody
/// fetches them in time the oldest is dropped and counted as overrun. A camera that goes away is looked for
/// until it is back: next() says nothing_yet meanwhile and status() says why. Picture memory is handed round,
/// not allocated per picture.
class DeviceCamera final : public CameraSource {
 public:
  static constexpr std::size_t kQueue = 4;

  explicit DeviceCamera(std::unique_ptr<CaptureDevice> device, DeviceCameraTiming timing = {});
  ~DeviceCamera() override;

  /// Opens the camera, so that its absence is told at once, then starts the capture thread. A second call
  /// after a failure tries again.
  Result<void> start() override;
  Result<Pull> next(Frame& frame) override;
  bool live() const override { return true; }
  std::string description() const override;
  CameraStatus status() const override;
  Nanoseconds period() const override;

  /// Carried out by the capture thread; what the camera refuses appears in status().remarks.
  Result<void> set_exposure(double milliseconds) override;
  Result<void> set_gain(double gain) override;

 private:
  void run();
  void opened(OpenedDevice opened);
  void capture();
  void publish(Nanoseconds stamp);
  void lose(const std::string& reason);
  void reconnect();
  void apply_requests();
  bool pause(Nanoseconds time);
  bool disconnected() const;
  bool stopping() const;

  std::unique_ptr<CaptureDevice> device_;  ///< capture thread only, once it runs
  const DeviceCameraTiming timing_;
  Frame scratch_;                 ///< capture thread only
  Nanoseconds last_picture_ = 0;  ///< capture thread only
  std::uint64_t captured_ = 0;    ///< capture thread only

  mutable std::mutex mutex_;  ///< everything below
  std::condition_variable changed_;
  std::array<Frame, kQueue> queue_;
  std::size_t first_ = 0;
  std::size_t count_ = 0;
  bool stop_ = false;
  std::optional<double> exposure_request_;
  std::optional<double> gain_request_;
  std::string description_;
  Nanoseconds period_ = 0;
  CameraStatus status_;
  std::string exposure_remark_;  ///< why the last asked exposure was refused
  std::string gain_remark_;

  std::thread thread_;
};

}  // namespace linescope
