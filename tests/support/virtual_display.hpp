// A display of its own for windows under test.
#pragma once

#include <string>

#include "tests/support/child_process.hpp"

namespace linescope::testing {

/// An Xvfb that lives as long as this object.
class VirtualDisplay {
 public:
  VirtualDisplay();

  /// False when Xvfb is not installed or did not come up.
  bool up() const { return !number_.empty(); }
  /// For a child's environment: "DISPLAY=:7".
  std::string variable() const { return "DISPLAY=:" + number_; }

 private:
  ChildProcess server_;
  std::string number_;
};

}  // namespace linescope::testing
