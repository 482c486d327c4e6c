// Polhemus products on USB, told apart by product id (vendor 0f44).
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace linescope {

inline constexpr std::uint16_t kPolhemusVendor = 0x0f44;

struct UsbProduct {
  enum class Kind : std::uint8_t {
    liberty,  ///< running
    loader,   ///< a LIBERTY that waits for its firmware: it comes back under another id once it has it
    other,    ///< Polhemus, but another product
  };
  std::uint16_t id = 0;
  Kind kind = Kind::other;
  std::string_view name;
  std::uint8_t out =
      0;  ///< endpoints of the command and data pipe; the unit has further ones of unknown purpose,
  std::uint8_t in = 0;  ///< so "the first IN endpoint" would be the wrong one
};

/// Everything known.
std::span<const UsbProduct> usb_products();
/// Nothing known: nullptr.
const UsbProduct* find_usb_product(std::uint16_t id);

}  // namespace linescope
