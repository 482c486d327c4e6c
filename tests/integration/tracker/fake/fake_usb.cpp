#include "tests/integration/tracker/fake/fake_usb.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <utility>

namespace linescope::testing {
namespace {

constexpr std::uint8_t kOut = 0x04;
constexpr std::uint8_t kIn = 0x88;
constexpr int kPacket = 512;

void check(bool ok, const char* what, GError* error = nullptr) {
  if (!ok)
    throw std::runtime_error(
        fmt::format("fake USB: {}: {}", what, error != nullptr ? error->message : "failed"));
}

/// Device, configuration, interface and the four bulk endpoints of the unit's firmware.
std::vector<std::uint8_t> descriptors(std::uint16_t product) {
  std::vector<std::uint8_t> bytes = {18,
                                     1,
                                     0x00,
                                     0x02,
                                     0,
                                     0,
                                     0,
                                     64,
                                     0x44,
                                     0x0f,
                                     static_cast<std::uint8_t>(product & 0xff),
                                     static_cast<std::uint8_t>(product >> 8),
                                     0,
                                     0,
                                     1,
                                     2,
                                     0,
                                     1,
                                     9,
                                     2,
                                     46,
                                     0,
                                     1,
                                     1,
                                     0,
                                     0x80,
                                     50,
                                     9,
                                     4,
                                     0,
                                     0,
                                     4,
                                     0xff,
                                     0,
                                     0,
                                     0};
  for (const int endpoint : {0x82, 0x04, 0x06, 0x88})
    for (const int byte : {7, 5, endpoint, 2, 0x00, 0x02, 0})
      bytes.push_back(static_cast<std::uint8_t>(byte));
  return bytes;
}

usbdevfs_urb* urb_of(UMockdevIoctlData* data) {
  return reinterpret_cast<usbdevfs_urb*>(data->data);
}

gboolean complete(UMockdevIoctlClient* client, long result, int error = 0) {
  umockdev_ioctl_client_complete(client, result, error);
  return TRUE;
}

gboolean refuse(UMockdevIoctlClient* client, int error) {
  return complete(client, -1, error);
}

}  // namespace

FakeBus::FakeBus() : testbed_(umockdev_testbed_new()) {
  check(umockdev_in_mock_environment() != 0, "umockdev's preload library is missing");
  std::filesystem::create_directories(root() + "/dev/bus/usb");  // libusb looks for it when it starts
}

FakeBus::~FakeBus() {
  g_object_unref(testbed_);
}

std::string FakeBus::root() const {
  gchar* path = umockdev_testbed_get_root_dir(testbed_);
  std::string result = path;
  g_free(path);
  return result;
}

FakeUsb::FakeUsb(FakeBus& bus, FakeLiberty& unit, const UsbPlace& place)
    : bus_(bus),
      unit_(unit),
      place_(place),
      node_(fmt::format("/dev/bus/usb/{:03}/{:03}", place.bus, place.device)),
      syspath_(fmt::format("/devices/pci0000:00/0000:00:14.0/usb{0}/{0}-{1}", place.bus, place.port)) {
  make_node();
  handler_ = umockdev_ioctl_base_new();
  g_signal_connect(handler_, "handle-ioctl", G_CALLBACK(&FakeUsb::on_ioctl), this);
  GError* error = nullptr;
  check(umockdev_testbed_attach_ioctl(bus_.testbed(), node_.c_str(), handler_, &error) != 0, "attach", error);
  add_to_sysfs();  // last: this announces the device
  ticker_ = std::thread([this] {
    while (!stopping_) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      const std::lock_guard lock(mutex_);
      pump();
    }
  });
}

/// Who still holds the device open gets no answers from here on.
FakeUsb::~FakeUsb() {
  unplug();
  {
    const std::lock_guard lock(mutex_);
    g_signal_handlers_disconnect_by_data(handler_, this);
  }
  stopping_ = true;
  ticker_.join();
  umockdev_testbed_detach_ioctl(bus_.testbed(), node_.c_str(), nullptr);
  g_object_unref(handler_);
  ::close(gate_);
  ::unlink((bus_.root() + node_).c_str());
}

void FakeUsb::add_to_sysfs() {
  std::string hex;
  for (const std::uint8_t byte : descriptors(place_.product)) hex += fmt::format("{:02X}", byte);
  const std::string text = fmt::format(
      "P: {0}\nE: DEVTYPE=usb_device\nE: SUBSYSTEM=usb\nE: DRIVER=usb\nE: DEVNAME={1}\nE: BUSNUM={2:03}\n"
      "E: DEVNUM={3:03}\nE: MAJOR=189\nE: MINOR={4}\nE: PRODUCT=f44/{5:04x}/0\nE: TYPE=0/0/0\nE: "
      "ID_VENDOR_ID=0f44\n"
      "E: ID_MODEL_ID={5:04x}\nA: bConfigurationValue=1\\n\nA: bNumConfigurations=1\\n\nA: speed=480\\n\n"
      "A: version= 2.00\\n\nA: busnum={2}\\n\nA: devnum={3}\\n\nA: dev=189:{4}\\n\nA: idVendor=0f44\\n\n"
      "A: idProduct={5:04x}\\n\nA: manufacturer=Polhemus\\n\nA: product=Liberty 2.0\\n\nH: descriptors={6}\n",
      syspath_, node_, place_.bus, place_.device, place_.device - 1, place_.product, hex);
  GError* error = nullptr;
  check(umockdev_testbed_add_from_string(bus_.testbed(), text.c_str(), &error) != 0, "add", error);
}

/// A plain file as device node is always ready to poll and libusb would spin. A pipe with a single slot is a
/// gate instead: full while nothing can be reaped, empty when something can.
void FakeUsb::make_node() {
  const std::string path = bus_.root() + node_;
  std::filesystem::create_directories(std::filesystem::path(path).parent_path());
  check(::mkfifo(path.c_str(), 0666) == 0, "mkfifo");
  gate_ = ::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  check(gate_ >= 0 && ::fcntl(gate_, F_SETPIPE_SZ, 4096) >= 0, "pipe");
  set_gate(false);
}

void FakeUsb::set_gate(bool ready) {
  if (ready == gate_open_) return;
  std::array<char, 4096> slot{};
  const ssize_t moved =
      ready ? ::read(gate_, slot.data(), slot.size()) : ::write(gate_, slot.data(), slot.size());
  if (moved > 0) gate_open_ = ready;
}

void FakeUsb::unplug() {
  {
    const std::lock_guard lock(mutex_);
    if (gone_) return;
    gone_ = true;
    for (const Urb& urb : waiting_) {
      finish(urb, -ESHUTDOWN, 0);
      done_.push_back(urb);
    }
    waiting_.clear();
    set_gate(true);
  }
  // umockdev's own removal sends no event before 0.18.4.
  umockdev_testbed_uevent(bus_.testbed(), ("/sys" + syspath_).c_str(), "remove");
  umockdev_testbed_remove_device(bus_.testbed(), ("/sys" + syspath_).c_str());
}

void FakeUsb::fail_next_in(int status) {
  const std::lock_guard lock(mutex_);
  faults_.push_back(status);
}

void FakeUsb::set_kernel_driver(const std::string& name) {
  const std::lock_guard lock(mutex_);
  kernel_driver_ = name;
}

std::string FakeUsb::kernel_driver() const {
  const std::lock_guard lock(mutex_);
  return kernel_driver_;
}

std::size_t FakeUsb::queued_in() const {
  const std::lock_guard lock(mutex_);
  return waiting_.size();
}

gboolean FakeUsb::on_ioctl(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self) {
  return static_cast<FakeUsb*>(self)->handle(client);
}

gboolean FakeUsb::handle(UMockdevIoctlClient* client) {
  const unsigned long request = umockdev_ioctl_client_get_request(client);
  UMockdevIoctlData* arg = umockdev_ioctl_client_get_arg(client);  // borrowed
  const std::size_t size = _IOC_SIZE(request);
  UMockdevIoctlData* data = size > 0 ? umockdev_ioctl_data_resolve(arg, 0, size, nullptr) : nullptr;  // owned
  const std::lock_guard lock(mutex_);
  gboolean handled = FALSE;
  switch (request) {
    case USBDEVFS_SUBMITURB:
      handled = submit(client, data);
      break;
    case USBDEVFS_DISCARDURB:
      handled = discard(client, *reinterpret_cast<unsigned long*>(arg->data));
      break;
    case USBDEVFS_REAPURB:
    case USBDEVFS_REAPURBNDELAY:
      handled = reap(client, data);
      break;
    default:
      handled = handle_interface(request, client, data);
      break;
  }
  if (data != nullptr) g_object_unref(data);
  return handled;
}

gboolean FakeUsb::handle_interface(unsigned long request, UMockdevIoctlClient* client,
                                   UMockdevIoctlData* data) {
  if (request == USBDEVFS_GET_CAPABILITIES) {
    *reinterpret_cast<std::uint32_t*>(data->data) =
        USBDEVFS_CAP_ZERO_PACKET | USBDEVFS_CAP_BULK_CONTINUATION | USBDEVFS_CAP_NO_PACKET_SIZE_LIM |
        USBDEVFS_CAP_REAP_AFTER_DISCONNECT;
    return complete(client, 0);
  }
  if (gone_) return refuse(client, ENODEV);
  switch (request) {
    case USBDEVFS_CLAIMINTERFACE:
      if (claim_error_ != 0) return refuse(client, claim_error_);
      if (!kernel_driver_.empty()) return refuse(client, EBUSY);
      claimed_ = true;
      return complete(client, 0);
    case USBDEVFS_RELEASEINTERFACE:
      claimed_ = false;
      return complete(client, 0);
    case USBDEVFS_GETDRIVER: {
      if (kernel_driver_.empty()) return refuse(client, ENODATA);
      auto* driver = reinterpret_cast<usbdevfs_getdriver*>(data->data);
      std::strncpy(driver->driver, kernel_driver_.c_str(), sizeof driver->driver - 1);
      return complete(client, 0);
    }
    case USBDEVFS_IOCTL: {
      const auto* inner = reinterpret_cast<usbdevfs_ioctl*>(data->data);
      if (static_cast<unsigned>(inner->ioctl_code) == USBDEVFS_DISCONNECT)
        kernel_driver_.clear();
      else
        kernel_driver_ = "usbserial";
      return complete(client, 0);
    }
    case USBDEVFS_SETCONFIGURATION:
    case USBDEVFS_CLEAR_HALT:
      return complete(client, 0);
    default:
      return refuse(client, ENOTTY);
  }
}

gboolean FakeUsb::submit(UMockdevIoctlClient* client, UMockdevIoctlData* data) {
  if (gone_) return refuse(client, ENODEV);
  usbdevfs_urb* urb = urb_of(data);
  Urb entry{UMOCKDEV_IOCTL_DATA(g_object_ref(data)), nullptr};
  if (urb->buffer_length > 0)
    entry.buffer = umockdev_ioctl_data_resolve(data, offsetof(usbdevfs_urb, buffer),
                                               static_cast<gsize>(urb->buffer_length), nullptr);
  urb->actual_length = 0;
  if (urb->endpoint == kOut) {
    unit_.receive({entry.buffer->data, static_cast<std::size_t>(urb->buffer_length)});
    finish(entry, 0, urb->buffer_length);
    done_.push_back(entry);
  } else if (urb->endpoint == kIn) {
    waiting_.push_back(entry);
  } else {
    finish(entry, -EPIPE, 0);
    done_.push_back(entry);
  }
  pump();
  return complete(client, 0);
}

gboolean FakeUsb::discard(UMockdevIoctlClient* client, unsigned long address) {
  const auto found = std::find_if(waiting_.begin(), waiting_.end(),
                                  [address](const Urb& urb) { return urb.urb->client_addr == address; });
  if (found == waiting_.end()) return refuse(client, EINVAL);
  finish(*found, -ENOENT, urb_of(found->urb)->actual_length);
  done_.push_back(*found);
  waiting_.erase(found);
  set_gate(true);
  return complete(client, 0);
}

gboolean FakeUsb::reap(UMockdevIoctlClient* client, UMockdevIoctlData* data) {
  if (done_.empty()) {
    set_gate(gone_);
    return refuse(client, gone_ ? ENODEV : EAGAIN);
  }
  const Urb urb = done_.front();
  done_.pop_front();
  set_gate(!done_.empty() || gone_);
  umockdev_ioctl_data_set_ptr(data, 0, urb.urb);
  complete(client, 0);  // copies transfer and buffer back
  if (urb.buffer != nullptr) g_object_unref(urb.buffer);
  g_object_unref(urb.urb);
  return TRUE;
}

void FakeUsb::finish(const Urb& urb, int status, int length) {
  urb_of(urb.urb)->status = status;
  urb_of(urb.urb)->actual_length = length;
}

void FakeUsb::pump() {
  while (!waiting_.empty() && fill(waiting_.front())) {
    done_.push_back(waiting_.front());
    waiting_.pop_front();
  }
  if (!done_.empty()) set_gate(true);
}

/// Packets go into the oldest transfer until a short packet or its end; true when it is finished.
bool FakeUsb::fill(Urb& entry) {
  usbdevfs_urb* urb = urb_of(entry.urb);
  if (!faults_.empty()) {
    finish(entry, std::exchange(faults_.front(), 0), 0);
    faults_.pop_front();
    return true;
  }
  while (urb->actual_length < urb->buffer_length) {
    const auto packet = unit_.next_packet();
    if (!packet) return false;
    const int room = urb->buffer_length - urb->actual_length;
    const int size = static_cast<int>(packet->size());
    std::memcpy(entry.buffer->data + urb->actual_length, packet->data(),
                static_cast<std::size_t>(std::min(room, size)));
    finish(entry, size > room ? -EOVERFLOW : 0, urb->actual_length + std::min(room, size));
    if (size < kPacket || size > room) return true;
  }
  return true;
}

}  // namespace linescope::testing
