// The USB bus as libusb shows it: which Polhemus devices are there, and when that changes.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "acquire/tracker/liberty/usb_products.hpp"
#include "common/result.hpp"
#include "common/time.hpp"

struct libusb_context;
struct libusb_device;

namespace linescope {

/// A device that was seen; keeps libusb's reference.
struct UsbFinding {
  std::shared_ptr<libusb_device> device;
  std::uint16_t id = 0;
  std::string path;  ///< bus and ports: "1-2.3"
};

/// "USB 1-2 (0f44:ff20)"
std::string describe(const UsbFinding& finding);

/// Why it cannot be opened, from libusb's error code: permission (with the udev rule), busy, gone.
Error usb_open_error(const UsbFinding& finding, int libusb_error);

/// Why a Polhemus device that is no running LIBERTY cannot be used: waits for its firmware, or is another
/// product.
Error usb_product_error(const UsbFinding& finding);

class UsbBus {
 public:
  static Result<std::unique_ptr<UsbBus>> open();
  ~UsbBus();
  UsbBus(const UsbBus&) = delete;
  UsbBus& operator=(const UsbBus&) = delete;

  libusb_context* context() const { return context_; }

  /// All devices of the vendor.
  std::vector<UsbFinding> polhemus() const;

  /// The one LIBERTY to use, or a sentence on what is there instead. `path` chooses among several.
  Result<UsbFinding> find_liberty(const std::string& path) const;

  /// True once after something of the vendor was plugged in or out.
  bool take_change() { return changed_.exchange(false); }
  /// Runs libusb's events until a change or that long.
  void wait_for_change(Nanoseconds at_most);

 private:
  explicit UsbBus(libusb_context* context);

  libusb_context* context_;
  int hotplug_ = 0;
  bool has_hotplug_ = false;
  std::atomic<bool> changed_{false};
};

/// libusb's events for at most that long.
void handle_usb_events(libusb_context* context, Nanoseconds at_most);

}  // namespace linescope
