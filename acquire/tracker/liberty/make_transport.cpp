#include "acquire/tracker/liberty/liberty_source.hpp"
#include "acquire/tracker/liberty/serial_transport.hpp"
#include "acquire/tracker/liberty/usb_transport.hpp"

namespace linescope {

std::unique_ptr<ByteTransport> make_transport(const LibertyOptions& options) {
  if (options.port == LibertyPort::serial)
    return std::make_unique<SerialTransport>(options.serial_device, options.baud);
  return std::make_unique<UsbTransport>(options.usb_path);
}

}  // namespace linescope
