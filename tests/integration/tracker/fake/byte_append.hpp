// A number as the unit sends it: little endian, as this machine keeps it.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <vector>

namespace linescope::testing {

template <class T>
void append(std::vector<std::uint8_t>& out, T value) {
  std::array<std::uint8_t, sizeof(T)> bytes;
  std::memcpy(bytes.data(), &value, sizeof value);
  out.insert(out.end(), bytes.begin(), bytes.end());
}

}  // namespace linescope::testing
