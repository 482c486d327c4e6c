#include "acquire/tracker/liberty/usb_products.hpp"

#include <algorithm>
#include <array>

namespace linescope {
namespace {

using Kind = UsbProduct::Kind;

constexpr std::array kProducts = {
    UsbProduct{0xff20, Kind::liberty, "LIBERTY", 0x04, 0x88},
    UsbProduct{0xff12, Kind::liberty, "LIBERTY (USB 1)", 0x02, 0x82},
    UsbProduct{0xff21, Kind::loader, "LIBERTY without firmware", 0, 0},
    UsbProduct{0xff11, Kind::loader, "LIBERTY (USB 1) without firmware", 0, 0},
    UsbProduct{0xef20, Kind::other, "PATRIOT", 0, 0},
    UsbProduct{0xef21, Kind::other, "PATRIOT without firmware", 0, 0},
    UsbProduct{0xef12, Kind::other, "PATRIOT (USB 1)", 0, 0},
    UsbProduct{0xef11, Kind::other, "PATRIOT (USB 1) without firmware", 0, 0},
    UsbProduct{0x0001, Kind::other, "FASTRAK without firmware", 0, 0},
    UsbProduct{0x0002, Kind::other, "FASTRAK", 0, 0},
    UsbProduct{0x0003, Kind::other, "FASTRAK 3", 0, 0},
    UsbProduct{0xcf01, Kind::other, "G4", 0, 0},
    UsbProduct{0xbf01, Kind::other, "VIPER", 0, 0},
};

}  // namespace

std::span<const UsbProduct> usb_products() {
  return kProducts;
}

const UsbProduct* find_usb_product(std::uint16_t id) {
  const auto* found =
      std::find_if(kProducts.begin(), kProducts.end(), [id](const auto& p) { return p.id == id; });
  return found == kProducts.end() ? nullptr : found;
}

}  // namespace linescope
