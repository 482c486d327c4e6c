// A LIBERTY on a serial line: raw 8N1, no handshake.
#pragma once

#include <array>

#include "acquire/tracker/liberty/byte_transport.hpp"

namespace linescope {

class SerialTransport : public ByteTransport {
 public:
  SerialTransport(std::string device, int baud) : device_(std::move(device)), baud_(baud) {}
  ~SerialTransport() override { close(); }

  Result<void> open() override;
  void close() override;
  Result<void> write(std::string_view bytes) override;
  Result<Chunk> read(Nanoseconds at_most) override;
  void wait_for_change(Nanoseconds at_most) override;
  std::string description() const override;
  std::string silence_hint() const override;
  std::uint64_t faults() const override { return 0; }

 private:
  tl::unexpected<Error> gone() const;
  tl::unexpected<Error> cannot_open(int error) const;
  Result<void> take_exclusively();
  Result<void> set_line();

  std::string device_;
  int baud_;
  int fd_ = -1;
  std::array<std::uint8_t, 4096> buffer_;
};

}  // namespace linescope
