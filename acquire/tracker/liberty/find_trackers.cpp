#include "acquire/tracker/liberty/find_trackers.hpp"

#include <libusb.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

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

/// The kernel makes nodes for serial ports that no board has: their type is 0.
bool has_port(const std::string& name) {
  std::ifstream file("/sys/class/tty/" + name + "/type");
  int type = 0;
  return (file >> type) && type != 0;
}

bool is_serial_line(const std::string& name) {
  if (name.starts_with("ttyUSB") || name.starts_with("ttyACM")) return true;
  return name.starts_with("ttyS") && has_port(name);
}

std::vector<TrackerFinding> serial_lines() {
  std::vector<TrackerFinding> lines;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator("/dev", ignored)) {
    if (!is_serial_line(entry.path().filename().string())) continue;
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

Result<std::string> look_for_liberty(const LibertyOptions& options) {
  if (auto valid = validate(options); !valid) return tl::unexpected(valid.error());
  if (options.port == LibertyPort::serial) {
    SerialTransport line(options.serial_device, options.baud);
    if (auto opened = line.open(); !opened) return tl::unexpected(opened.error());
    return "serial line " + options.serial_device;
  }
  auto bus = UsbBus::open();
  if (!bus) return tl::unexpected(bus.error());
  auto found = (*bus)->find_liberty(options.usb_path);
  if (!found) return tl::unexpected(found.error());
  if (auto obstacle = obstacle_of(*found)) return tl::unexpected(*obstacle);
  return describe(*found);
}

}  // namespace linescope
