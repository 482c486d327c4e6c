// A scripted LIBERTY on a mocked USB bus: an unmodified libusb, in this process or in a child, sees /sys and
// /dev entries and its ioctls are answered here (umockdev). Needs umockdev's preload library: see
// umockdev_main.cpp.
#pragma once

#include <umockdev.h>

#include <atomic>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "tests/integration/tracker/fake/fake_liberty.hpp"

namespace linescope::testing {

/// The mocked /sys and /dev; one per test. Child processes must end before it does.
class FakeBus {
 public:
  FakeBus();
  ~FakeBus();
  FakeBus(const FakeBus&) = delete;
  FakeBus& operator=(const FakeBus&) = delete;
  UMockdevTestbed* testbed() const { return testbed_; }
  std::string root() const;

 private:
  UMockdevTestbed* testbed_;
};

struct UsbPlace {
  std::uint16_t product = 0xff20;
  int bus = 1;
  int device = 10;         ///< changes with every renumeration
  std::string port = "2";  ///< path "1-2"
};

/// Plugged in from construction to unplug() or destruction. Destroy it after those who use it have closed it.
class FakeUsb {
 public:
  FakeUsb(FakeBus& bus, FakeLiberty& unit, const UsbPlace& place = {});
  ~FakeUsb();
  FakeUsb(const FakeUsb&) = delete;
  FakeUsb& operator=(const FakeUsb&) = delete;

  /// Pulls the plug: transfers under way fail, further ones are refused, the kernel says "remove".
  void unplug();

  /// The next IN transfer ends with this status (-EPIPE: stall, -EOVERFLOW: babble, -EPROTO ...).
  void fail_next_in(int status);
  /// While it lives nobody fetches anything from the unit, as if the host were stopped.
  class Hold {
   public:
    explicit Hold(FakeUsb& usb) : lock_(usb.mutex_) {}

   private:
    std::lock_guard<std::mutex> lock_;
  };

  /// Claiming the interface fails with this errno from now on; 0: works again.
  void set_claim_error(int error) { claim_error_ = error; }
  /// A kernel driver of that name sits on the interface.
  void set_kernel_driver(const std::string& name);
  std::string kernel_driver() const;
  bool claimed() const { return claimed_; }
  /// IN transfers waiting in the kernel.
  std::size_t queued_in() const;

 private:
  struct Urb {
    UMockdevIoctlData* urb = nullptr;
    UMockdevIoctlData* buffer = nullptr;
  };

  void add_to_sysfs();
  void make_node();
  static gboolean on_ioctl(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self);
  gboolean handle(UMockdevIoctlClient* client);
  gboolean handle_interface(unsigned long request, UMockdevIoctlClient* client, UMockdevIoctlData* data);
  gboolean submit(UMockdevIoctlClient* client, UMockdevIoctlData* data);
  gboolean discard(UMockdevIoctlClient* client, unsigned long address);
  gboolean reap(UMockdevIoctlClient* client, UMockdevIoctlData* data);
  void pump();
  bool fill(Urb& urb);
  void finish(const Urb& urb, int status, int length);
  void set_gate(bool ready);

  FakeBus& bus_;
  FakeLiberty& unit_;
  UsbPlace place_;
  std::string node_;
  std::string syspath_;
  UMockdevIoctlBase* handler_ = nullptr;
  mutable std::mutex mutex_;
  std::deque<Urb> waiting_;
  std::deque<Urb> done_;
  std::deque<int> faults_;
  std::string kernel_driver_;
  std::atomic<int> claim_error_{0};
  std::atomic<bool> claimed_{false};
  bool gone_ = false;
  int gate_ = -1;
  bool gate_open_ = true;
  std::atomic<bool> stopping_{false};
  std::thread ticker_;
};

}  // namespace linescope::testing
