// The items a LIBERTY sends per record (command O), and where they lie.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "acquire/tracker/liberty/liberty_options.hpp"

namespace linescope {

/// Numbers as in the unit's command O.
enum class OutputItem : std::uint8_t {
  space = 0,
  line_end = 1,
  position = 2,
  position_extended = 3,
  euler = 4,
  euler_extended = 5,
  cosines = 6,
  quaternion = 7,
  timestamp = 8,
  frame_count = 9,
  stylus = 10,
  distortion = 11,
  external_sync = 12,
};

/// Size of an item in a binary record.
constexpr std::size_t binary_size(OutputItem item) {
  switch (item) {
    case OutputItem::space:
      return 1;
    case OutputItem::line_end:
      return 2;
    case OutputItem::position:
    case OutputItem::position_extended:
    case OutputItem::euler:
    case OutputItem::euler_extended:
      return 12;
    case OutputItem::cosines:
      return 36;
    case OutputItem::quaternion:
      return 16;
    default:
      return 4;
  }
}

/// Numbers an item holds in an ASCII record.
constexpr int number_count(OutputItem item) {
  switch (item) {
    case OutputItem::space:
    case OutputItem::line_end:
      return 0;
    case OutputItem::position:
    case OutputItem::position_extended:
    case OutputItem::euler:
    case OutputItem::euler_extended:
      return 3;
    case OutputItem::cosines:
      return 9;
    case OutputItem::quaternion:
      return 4;
    default:
      return 1;
  }
}

class OutputList {
 public:
  static constexpr std::size_t kMost = 20;  ///< the unit's limit

  /// Frame count, then whatever the options ask for, then position, and the quaternion last: a byte lost
  /// anywhere in a record then spoils the quaternion's length, which is checked. ASCII ends with a line end.
  static OutputList for_options(const LibertyOptions& options);

  void add(OutputItem item);
  std::span<const OutputItem> items() const { return {items_.data(), size_}; }
  std::size_t body_size() const;
  /// Offset of an item in the binary body; nothing when it is not in the list.
  std::optional<std::size_t> offset_of(OutputItem item) const;
  /// "9,8,11,10,2,7"
  std::string text() const;

 private:
  std::array<OutputItem, kMost> items_{};
  std::size_t size_ = 0;
};

}  // namespace linescope
