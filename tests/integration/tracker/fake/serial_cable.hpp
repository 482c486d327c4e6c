// Carries bytes between a scripted unit and the slave side of a pseudo-terminal: a serial line.
#pragma once

#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <stdexcept>
#include <string>
#include <thread>

#include "tests/integration/tracker/fake/fake_liberty.hpp"

namespace linescope::testing {

class SerialCable {
 public:
  explicit SerialCable(FakeLiberty& unit)
      : unit_(unit), master_(::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC)) {
    if (::grantpt(master_) != 0 || ::unlockpt(master_) != 0) throw std::runtime_error("no pseudo-terminal");
    device_ = ::ptsname(master_);
    // The line exists without the driver, too.
    keep_open_ = ::open(device_.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
    termios raw{};
    ::tcgetattr(keep_open_, &raw);
    ::cfmakeraw(&raw);
    ::tcsetattr(keep_open_, TCSANOW, &raw);
    carrier_ = std::thread([this] { carry(); });
  }
  ~SerialCable() { pull(); }
  SerialCable(const SerialCable&) = delete;
  SerialCable& operator=(const SerialCable&) = delete;

  const std::string& device() const { return device_; }

  void pull() {
    stopping_ = true;
    if (carrier_.joinable()) carrier_.join();
    if (master_ >= 0) ::close(master_);
    if (keep_open_ >= 0) ::close(keep_open_);
    master_ = keep_open_ = -1;
  }

 private:
  void carry() {
    std::array<std::uint8_t, 256> buffer;
    while (!stopping_) {
      pollfd ready{master_, POLLIN, 0};
      if (::poll(&ready, 1, 1) > 0 && (ready.revents & POLLIN) != 0) {
        const ssize_t n = ::read(master_, buffer.data(), buffer.size());
        if (n > 0) unit_.receive({buffer.data(), static_cast<std::size_t>(n)});
      }
      while (const auto packet = unit_.next_packet())
        if (::write(master_, packet->data(), packet->size()) < 0) break;
    }
  }

  FakeLiberty& unit_;
  int master_;
  int keep_open_ = -1;
  std::string device_;
  std::atomic<bool> stopping_{false};
  std::thread carrier_;
};

}  // namespace linescope::testing
