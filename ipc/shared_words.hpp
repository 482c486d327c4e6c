// The only way in which bytes go into and out of a shared mapping: word by word, atomically, so that a reader
// who copies while the writer overwrites gets old or new words, never undefined behaviour, and finds out
// afterwards from an index.
//
// Every word is stored with release and loaded with acquire order. On x86-64 these are plain moves. It means:
// who has seen a word of an update also sees everything that was stored before it, in particular the index
// that announces the overwriting. No fences are needed, which ThreadSanitizer would not understand.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace linescope::shared {

template <class T>
T load(const T& shared) noexcept {
  return __atomic_load_n(&shared, __ATOMIC_ACQUIRE);
}

template <class T>
void store(T& shared, T value) noexcept {
  __atomic_store_n(&shared, value, __ATOMIC_RELEASE);
}

template <class T>
void add(T& shared, T value) noexcept {
  __atomic_fetch_add(&shared, value, __ATOMIC_RELAXED);
}

/// Running sum over 64-bit words that sees swapped, missing and changed words: a = start + sum of the words,
/// b = sum of all intermediate a; both modulo 2^64. Cheap enough to be taken while copying.
class Checksum {
 public:
  void add(std::uint64_t word) noexcept {
    a_ += word;
    b_ += a_;
  }
  /// Never 0, so that a record of zeros is not taken for a good one.
  std::uint64_t value() const noexcept { return (a_ ^ ((b_ << 32) | (b_ >> 32))) | 1U; }

 private:
  std::uint64_t a_ = 0x9e3779b97f4a7c15U;
  std::uint64_t b_ = 0;
};

/// Copies `words` 64-bit words into the mapping. `to` is 8-byte aligned, `from` need not be.
void copy_in(void* to, const void* from, std::size_t words) noexcept;
void copy_in(void* to, const void* from, std::size_t words, Checksum& sum) noexcept;

/// Copies `words` 64-bit words out of the mapping. `from` is 8-byte aligned, `to` need not be.
void copy_out(void* to, const void* from, std::size_t words) noexcept;
void copy_out(void* to, const void* from, std::size_t words, Checksum& sum) noexcept;

/// A whole structure; its size is a multiple of 8 by layout.
template <class T>
void put(T& shared, const T& value) noexcept {
  static_assert(sizeof(T) % 8 == 0);
  copy_in(&shared, &value, sizeof(T) / 8);
}

template <class T>
void get(T& value, const T& shared) noexcept {
  static_assert(sizeof(T) % 8 == 0);
  copy_out(&value, &shared, sizeof(T) / 8);
}

}  // namespace linescope::shared
