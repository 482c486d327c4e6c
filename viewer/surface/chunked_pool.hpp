// Records that never move: growing copies nothing, so the cost of the next record does not depend on how many
// there are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace linescope {

template <class T>
class ChunkedPool {
 public:
  T& operator[](std::int32_t i) {
    return chunks_[static_cast<std::size_t>(i) >> kBits][static_cast<std::size_t>(i) & kMask];
  }
  const T& operator[](std::int32_t i) const {
    return chunks_[static_cast<std::size_t>(i) >> kBits][static_cast<std::size_t>(i) & kMask];
  }

  /// A record in its default state; its number.
  std::int32_t add() {
    if (size_ == chunks_.size() << kBits) chunks_.push_back(std::make_unique<T[]>(std::size_t{1} << kBits));
    const auto number = static_cast<std::int32_t>(size_++);
    (*this)[number] = T{};
    return number;
  }

  std::size_t size() const { return size_; }
  void shrink(std::size_t size) { size_ = size; }  ///< forgets the newest ones; keeps the memory
  void clear() { size_ = 0; }                      ///< keeps the memory

 private:
  static constexpr std::size_t kBits = 6, kMask = (std::size_t{1} << kBits) - 1;
  std::vector<std::unique_ptr<T[]>> chunks_;
  std::size_t size_ = 0;
};

}  // namespace linescope
