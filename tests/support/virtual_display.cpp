#include "tests/support/virtual_display.hpp"

namespace linescope::testing {

VirtualDisplay::VirtualDisplay()
    : server_({"Xvfb", "-displayfd", "1", "-screen", "0", "1920x1080x24", "-nolisten", "tcp"}) {
  // The server writes the number of its display once it takes connections.
  eventually([&] { return server_.standard_output().find('\n') != std::string::npos || !server_.running(); });
  const std::string said = server_.standard_output();
  number_ = said.substr(0, said.find('\n'));
}

}  // namespace linescope::testing
