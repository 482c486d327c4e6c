#include "acquire/tracker/liberty/usb_bus.hpp"

#include <fmt/format.h>
#include <libusb.h>

#include <algorithm>
#include <array>

namespace linescope {
namespace {

std::string path_of(libusb_device* device) {
  std::array<std::uint8_t, 8> ports{};
  const int count = libusb_get_port_numbers(device, ports.data(), static_cast<int>(ports.size()));
  std::string path = fmt::format("{}-", libusb_get_bus_number(device));
  for (int i = 0; i < count; ++i)
    path += fmt::format("{}{}", i == 0 ? "" : ".", ports[static_cast<std::size_t>(i)]);
  return path;
}

std::string listed(const std::vector<UsbFinding>& findings) {
  std::string text;
  for (const UsbFinding& finding : findings) text += (text.empty() ? "" : ", ") + finding.path;
  return text;
}

std::vector<UsbFinding> of_kind(const std::vector<UsbFinding>& all, UsbProduct::Kind kind) {
  std::vector<UsbFinding> some;
  std::copy_if(all.begin(), all.end(), std::back_inserter(some), [kind](const UsbFinding& finding) {
    const UsbProduct* product = find_usb_product(finding.id);
    return (product == nullptr ? UsbProduct::Kind::other : product->kind) == kind;
  });
  return some;
}

tl::unexpected<Error> nothing_usable(const std::vector<UsbFinding>& all) {
  if (const auto loaders = of_kind(all, UsbProduct::Kind::loader); !loaders.empty())
    return tl::unexpected(usb_product_error(loaders.front()));
  if (!all.empty()) return tl::unexpected(usb_product_error(all.front()));
  return fail(ErrorCode::not_found, "LIBERTY: there is none on USB (0f44:ff20); switch it on and plug it in");
}

}  // namespace

std::string describe(const UsbFinding& finding) {
  return fmt::format("USB {} ({:04x}:{:04x})", finding.path, kPolhemusVendor, finding.id);
}

Error usb_product_error(const UsbFinding& finding) {
  const UsbProduct* product = find_usb_product(finding.id);
  if (product != nullptr && product->kind == UsbProduct::Kind::loader)
    return {
        ErrorCode::not_found,
        fmt::format(
            "LIBERTY: the unit on {} waits for its firmware; install fxload and Polhemus' firmware files as "
            "docs/liberty.md says, then plug it in again",
            describe(finding))};
  return {ErrorCode::unsupported,
          fmt::format("LIBERTY: {} is a {}, which is another product", describe(finding),
                      product != nullptr ? product->name : "Polhemus device")};
}

Error usb_open_error(const UsbFinding& finding, int error) {
  const std::string where = describe(finding);
  switch (error) {
    case LIBUSB_ERROR_ACCESS:
      return {ErrorCode::permission,
              fmt::format("LIBERTY: no permission to use {}; copy tools/udev/60-linescope-liberty.rules to "
                          "/etc/udev/rules.d, run 'udevadm control --reload' and plug the unit in again",
                          where)};
    case LIBUSB_ERROR_BUSY:
      return {ErrorCode::busy,
              fmt::format("LIBERTY: {} is in use by another program; end that one first", where)};
    case LIBUSB_ERROR_NO_DEVICE:
      return {ErrorCode::gone, fmt::format("LIBERTY: {} was unplugged while it was being opened", where)};
    default:
      return {ErrorCode::unreadable, fmt::format("LIBERTY: {} cannot be opened: {}", where,
                                                 libusb_strerror(static_cast<libusb_error>(error)))};
  }
}

void handle_usb_events(libusb_context* context, Nanoseconds at_most) {
  timeval wait{at_most / kSecond, (at_most % kSecond) / 1000};
  libusb_handle_events_timeout_completed(context, &wait, nullptr);
}

Result<std::unique_ptr<UsbBus>> UsbBus::open() {
  libusb_context* context = nullptr;
  if (const int error = libusb_init(&context); error != 0)
    return fail(ErrorCode::unreadable, fmt::format("LIBERTY: USB cannot be used on this machine: {}",
                                                   libusb_strerror(static_cast<libusb_error>(error))));
  return std::unique_ptr<UsbBus>(new UsbBus(context));
}

UsbBus::UsbBus(libusb_context* context) : context_(context) {
  if (libusb_has_capability(LIBUSB_CAP_HAS_HOTPLUG) == 0) return;
  const auto callback = [](libusb_context*, libusb_device*, libusb_hotplug_event, void* self) -> int {
    static_cast<UsbBus*>(self)->changed_ = true;
    return 0;
  };
  has_hotplug_ = libusb_hotplug_register_callback(
                     context_, LIBUSB_HOTPLUG_EVENT_DEVICE_ARRIVED | LIBUSB_HOTPLUG_EVENT_DEVICE_LEFT, 0,
                     kPolhemusVendor, LIBUSB_HOTPLUG_MATCH_ANY, LIBUSB_HOTPLUG_MATCH_ANY, callback, this,
                     &hotplug_) == LIBUSB_SUCCESS;
}

UsbBus::~UsbBus() {
  if (has_hotplug_) libusb_hotplug_deregister_callback(context_, hotplug_);
  libusb_exit(context_);
}

std::vector<UsbFinding> UsbBus::polhemus() const {
  std::vector<UsbFinding> findings;
  libusb_device** list = nullptr;
  const ssize_t count = libusb_get_device_list(context_, &list);
  for (ssize_t i = 0; i < count; ++i) {
    libusb_device_descriptor descriptor{};
    if (libusb_get_device_descriptor(list[i], &descriptor) != 0 || descriptor.idVendor != kPolhemusVendor)
      continue;
    findings.push_back(
        {{libusb_ref_device(list[i]), libusb_unref_device}, descriptor.idProduct, path_of(list[i])});
  }
  if (count >= 0) libusb_free_device_list(list, 1);
  return findings;
}

Result<UsbFinding> UsbBus::find_liberty(const std::string& path) const {
  const auto all = polhemus();
  auto units = of_kind(all, UsbProduct::Kind::liberty);
  const std::string found = listed(units);
  if (!path.empty()) {
    std::erase_if(units, [&](const UsbFinding& finding) { return finding.path != path; });
    if (units.empty() && !found.empty())
      return fail(ErrorCode::not_found,
                  fmt::format("LIBERTY: there is none on USB {}, but on {}", path, found));
  }
  if (units.empty()) return nothing_usable(all);
  if (units.size() > 1)
    return fail(ErrorCode::usage,
                fmt::format("LIBERTY: there are several, on USB {}; name the one to use (usb_path)", found));
  return units.front();
}

void UsbBus::wait_for_change(Nanoseconds at_most) {
  const Nanoseconds until = monotonic_now() + at_most;
  for (Nanoseconds left = at_most; left > 0 && !changed_; left = until - monotonic_now())
    handle_usb_events(context_, std::min(left, 100 * kMillisecond));
}

}  // namespace linescope
