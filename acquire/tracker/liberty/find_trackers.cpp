#include "acquire/tracker/liberty/find_trackers.hpp"

#include <libusb.h>

#include <algorithm>
#include <filesystem>

#include "acquire/tracker/liberty/serial_transport.hpp"
#include "acquire/tracker/liberty/usb_bus.hpp"

namespace linescope {
namespace {

std::optional<Error> obstacle_of(const UsbFinding& finding) {
  const UsbProduct* product = find_usb_product(finding.id);
  if (product == nullptr || product->kind != UsbProduct::Kind::liberty) return usb_product_error(finding);
  libusb_device_handle* handle = nullptr;
  if (const int error = libusb_open(finding.device.get(), &handle); error != 0)
    return usb_open_error(finding, error);
  const int error = libusb_kernel_driver_active(handle, 0) == 1 ? 0 : libusb_claim_interface(handle, 0);
  libusb_close(handle);
  if (error != 0) return usb_open_error(finding, error);
  return std::nullopt;
}

std::vector<TrackerFinding> serial_lines() {
  std::vector<TrackerFinding> lines;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator("/dev", ignored)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with("ttyUSB") && !name.starts_with("ttyACM")) continue;
    SerialTransport line(entry.path().string(), 115200);
    const auto opened = line.open();
    lines.push_back(
        {entry.path().string(), "serial line", opened ? std::nullopt : std::optional(opened.error())});
  }
  std::sort(lines.begin(), lines.end(), [](const auto& a, const auto& b) { return a.where < b.where; });
  return lines;
}

}  // namespace

Result<std::vector<TrackerFinding>> find_trackers() {
  auto bus = UsbBus::open();
  if (!bus) return tl::unexpected(bus.error());
  std::vector<TrackerFinding> findings;
  for (const UsbFinding& finding : (*bus)->polhemus()) {
    const UsbProduct* product = find_usb_product(finding.id);
    findings.push_back(
        {describe(finding), product ? std::string(product->name) : "Polhemus device", obstacle_of(finding)});
  }
  const auto lines = serial_lines();
  findings.insert(findings.end(), lines.begin(), lines.end());
  return findings;
}

}  // namespace linescope
