#include "acquire/tracker/liberty/usb_transport.hpp"

#include <fmt/format.h>
#include <libusb.h>

#include <algorithm>

namespace linescope {
namespace {

constexpr int kInterface = 0;
constexpr int kConfiguration = 1;
constexpr unsigned kWriteTimeout = 1000;  // ms
constexpr int kMostErrorsInARow = 16;

tl::unexpected<Error> cannot_open(const UsbFinding& device, int error) {
  return tl::unexpected(usb_open_error(device, error));
}

}  // namespace

Result<void> UsbTransport::open() {
  close();
  if (!bus_) {
    auto bus = UsbBus::open();
    if (!bus) return tl::unexpected(bus.error());
    bus_ = std::move(*bus);
  }
  bus_->take_change();
  auto found = bus_->find_liberty(path_);
  if (!found) return tl::unexpected(found.error());
  found_ = std::move(*found);
  product_ = find_usb_product(found_.id);
  if (const int error = libusb_open(found_.device.get(), &handle_); error != 0)
    return cannot_open(found_, error);
  auto ready = claim();
  if (ready) ready = submit_all();
  if (!ready) close();
  return ready;
}

/// A serial driver of the kernel may sit on the interface of an older unit: it is asked to step aside while
/// we are here.
Result<void> UsbTransport::claim() {
  if (libusb_kernel_driver_active(handle_, kInterface) == 1) {
    if (const int error = libusb_detach_kernel_driver(handle_, kInterface); error != 0)
      return cannot_open(found_, error);
    kernel_driver_detached_ = true;
  }
  int configuration = 0;
  if (libusb_get_configuration(handle_, &configuration) == 0 && configuration != kConfiguration)
    if (const int error = libusb_set_configuration(handle_, kConfiguration); error != 0)
      return cannot_open(found_, error);
  if (const int error = libusb_claim_interface(handle_, kInterface); error != 0)
    return cannot_open(found_, error);
  return {};
}

Result<void> UsbTransport::submit_all() {
  done_first_ = done_count_ = 0;
  held_ = nullptr;
  errors_in_a_row_ = 0;
  for (Slot& slot : slots_) {
    slot.owner = this;
    if (slot.transfer == nullptr) slot.transfer = libusb_alloc_transfer(0);
    libusb_fill_bulk_transfer(slot.transfer, handle_, product_->in, slot.buffer.data(), kBytes,
                              &UsbTransport::on_done, &slot, 0);
    if (auto submitted = submit(slot); !submitted) return submitted;
  }
  return {};
}

Result<void> UsbTransport::submit(Slot& slot) {
  const int error = libusb_submit_transfer(slot.transfer);
  if (error == 0) {
    slot.in_flight = true;
    return {};
  }
  if (error == LIBUSB_ERROR_NO_DEVICE) return gone();
  return fail(ErrorCode::gone, fmt::format("LIBERTY: {} takes no more transfers: {}", description(),
                                           libusb_strerror(static_cast<libusb_error>(error))));
}

void UsbTransport::on_done(libusb_transfer* transfer) {
  Slot& slot = *static_cast<Slot*>(transfer->user_data);
  UsbTransport& self = *slot.owner;
  slot.arrival = monotonic_now();
  slot.in_flight = false;
  const auto index = static_cast<std::size_t>(&slot - self.slots_.data());
  self.done_[(self.done_first_ + self.done_count_) % kTransfers] = index;
  ++self.done_count_;
}

void UsbTransport::close() {
  if (handle_ == nullptr) return;
  cancel_all();
  libusb_release_interface(handle_, kInterface);
  if (kernel_driver_detached_) libusb_attach_kernel_driver(handle_, kInterface);
  kernel_driver_detached_ = false;
  libusb_close(handle_);
  handle_ = nullptr;
  for (Slot& slot : slots_) {
    libusb_free_transfer(slot.transfer);
    slot.transfer = nullptr;
  }
}

void UsbTransport::cancel_all() {
  const auto flying = [this] {
    return std::any_of(slots_.begin(), slots_.end(), [](const Slot& slot) { return slot.in_flight; });
  };
  for (Slot& slot : slots_)
    if (slot.in_flight) libusb_cancel_transfer(slot.transfer);
  while (flying()) handle_usb_events(bus_->context(), 100 * kMillisecond);
}

Result<void> UsbTransport::write(std::string_view bytes) {
  std::array<unsigned char, 64> buffer;
  while (!bytes.empty()) {
    const std::size_t count = std::min(bytes.size(), buffer.size());
    std::copy_n(bytes.begin(), count, buffer.begin());
    int written = 0;
    const int error = libusb_bulk_transfer(handle_, product_->out, buffer.data(), static_cast<int>(count),
                                           &written, kWriteTimeout);
    if (error == LIBUSB_ERROR_NO_DEVICE) return gone();
    if (error != 0 || written <= 0)
      return fail(ErrorCode::timeout, fmt::format("LIBERTY: {} takes no commands: {}", description(),
                                                  libusb_strerror(static_cast<libusb_error>(error))));
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return {};
}

Result<Chunk> UsbTransport::read(Nanoseconds at_most) {
  if (held_ != nullptr)
    if (auto submitted = submit(*std::exchange(held_, nullptr)); !submitted)
      return tl::unexpected(submitted.error());
  const Nanoseconds until = monotonic_now() + at_most;
  for (;;) {
    while (done_count_ > 0) {
      Slot& slot = slots_[done_[done_first_]];
      done_first_ = (done_first_ + 1) % kTransfers;
      --done_count_;
      const auto has_bytes = settle(slot);
      if (!has_bytes) return tl::unexpected(has_bytes.error());
      if (!*has_bytes) continue;
      held_ = &slot;
      return Chunk{{slot.buffer.data(), static_cast<std::size_t>(slot.transfer->actual_length)},
                   slot.arrival};
    }
    const Nanoseconds left = until - monotonic_now();
    if (left <= 0) return Chunk{};
    handle_usb_events(bus_->context(), left);
  }
}

/// True: the slot holds bytes for the caller. False: it held none and is queued again.
Result<bool> UsbTransport::settle(Slot& slot) {
  switch (slot.transfer->status) {
    case LIBUSB_TRANSFER_COMPLETED:
      errors_in_a_row_ = 0;
      break;
    case LIBUSB_TRANSFER_NO_DEVICE:
      return gone();
    case LIBUSB_TRANSFER_STALL:
      clear_stall();
      [[fallthrough]];
    case LIBUSB_TRANSFER_OVERFLOW:
    case LIBUSB_TRANSFER_ERROR:
      ++faults_;
      if (++errors_in_a_row_ > kMostErrorsInARow) return gone();
      slot.transfer->actual_length = 0;
      break;
    default:
      break;
  }
  if (slot.transfer->actual_length > 0) return true;
  if (auto submitted = submit(slot); !submitted) return tl::unexpected(submitted.error());
  return false;
}

void UsbTransport::clear_stall() {
  libusb_clear_halt(handle_, product_->in);
}

tl::unexpected<Error> UsbTransport::gone() const {
  return fail(ErrorCode::gone, fmt::format("LIBERTY: {} was unplugged; plug it in again", describe(found_)));
}

void UsbTransport::wait_for_change(Nanoseconds at_most) {
  if (bus_) bus_->wait_for_change(at_most);
}

std::string UsbTransport::description() const {
  if (product_ == nullptr) return path_.empty() ? "USB" : "USB " + path_;
  return describe(found_);
}

std::string UsbTransport::silence_hint() const {
  return "switch it off and on, wait ten seconds for its self-test, and plug it in again";
}

}  // namespace linescope
