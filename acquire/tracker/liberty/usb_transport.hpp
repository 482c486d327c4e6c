// A LIBERTY on USB: bulk transfers, several queued so that the unit always finds a place to put its data.
#pragma once

#include <array>
#include <memory>

#include "acquire/tracker/liberty/byte_transport.hpp"
#include "acquire/tracker/liberty/usb_bus.hpp"

struct libusb_device_handle;
struct libusb_transfer;

namespace linescope {

/// All work, libusb's callbacks included, happens in the thread that calls; the arrival time is taken in the
/// callback.
class UsbTransport : public ByteTransport {
 public:
  /// `path` as in LibertyOptions::usb_path.
  explicit UsbTransport(std::string path) : path_(std::move(path)) {}
  ~UsbTransport() override { close(); }

  Result<void> open() override;
  void close() override;
  Result<void> write(std::string_view bytes) override;
  Result<Chunk> read(Nanoseconds at_most) override;
  void wait_for_change(Nanoseconds at_most) override;
  std::string description() const override;
  std::string silence_hint() const override;
  std::uint64_t faults() const override { return faults_; }

 private:
  /// A cycle ends with a short packet and so fills one transfer: together they last for 267 ms of 240 Hz in
  /// which nobody runs this thread. (The unit itself keeps 25 ms, and recordings of real ones show hosts that
  /// stood still for 237 ms.)
  static constexpr std::size_t kTransfers = 64;
  static constexpr std::size_t kBytes =
      2048;  ///< a multiple of every packet size: an odd size could overflow

  struct Slot {
    libusb_transfer* transfer = nullptr;
    std::array<unsigned char, kBytes> buffer;
    UsbTransport* owner = nullptr;
    bool in_flight = false;
    Nanoseconds arrival = 0;
  };

  Result<void> claim();
  Result<void> submit_all();
  Result<void> submit(Slot& slot);
  Result<bool> settle(Slot& slot);
  void clear_stall();
  void cancel_all();
  static void on_done(libusb_transfer* transfer);
  tl::unexpected<Error> gone() const;

  std::string path_;
  std::unique_ptr<UsbBus> bus_;
  UsbFinding found_;
  const UsbProduct* product_ = nullptr;
  libusb_device_handle* handle_ = nullptr;
  bool kernel_driver_detached_ = false;
  std::array<Slot, kTransfers> slots_;
  std::array<std::size_t, kTransfers> done_{};  ///< ring of finished slots, in the order of the stream
  std::size_t done_first_ = 0;
  std::size_t done_count_ = 0;
  Slot* held_ = nullptr;  ///< whose buffer the caller still reads
  int errors_in_a_row_ = 0;
  std::uint64_t faults_ = 0;
};

}  // namespace linescope
