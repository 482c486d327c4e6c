// Plain numbers to little-endian bytes and back; doubles keep every bit.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace linescope {

static_assert(std::endian::native == std::endian::little,
              "recordings are little-endian; add a byte swap here");

using Bytes = std::vector<std::uint8_t>;

class ByteWriter {
 public:
  explicit ByteWriter(Bytes& bytes) : bytes_(bytes) {}

  template <class Number>
  requires std::is_arithmetic_v<Number>
  void put(Number number) { raw(&number, sizeof number); }
  void text(std::string_view text) {
    put(static_cast<std::uint32_t>(text.size()));
    raw(text.data(), text.size());
  }
  void raw(const void* data, std::size_t size) {
    const auto* first = static_cast<const std::uint8_t*>(data);
    bytes_.insert(bytes_.end(), first, first + size);
  }

 private:
  Bytes& bytes_;
};

/// Reads behind the end give zeros and make ok() false, so that a whole record is read first and judged once.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::uint8_t> bytes) : rest_(bytes) {}

  template <class Number>
  requires std::is_arithmetic_v<Number> Number get() {
    Number number{};
    if (const auto bytes = take(sizeof number); !bytes.empty())
      std::memcpy(&number, bytes.data(), sizeof number);
    return number;
  }
  std::string text() {
    const auto bytes = take(get<std::uint32_t>());
    return {bytes.begin(), bytes.end()};
  }
  std::span<const std::uint8_t> rest() { return take(rest_.size()); }
  std::size_t left() const { return rest_.size(); }
  bool ok() const { return ok_; }

 private:
  std::span<const std::uint8_t> take(std::size_t size) {
    if (size > rest_.size()) {
      ok_ = false;
      return {};
    }
    const auto taken = rest_.first(size);
    rest_ = rest_.subspan(size);
    return taken;
  }

  std::span<const std::uint8_t> rest_;
  bool ok_ = true;
};

}  // namespace linescope
