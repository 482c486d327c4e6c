#include "ipc/shared_words.hpp"

namespace linescope::shared {
namespace {

constexpr std::size_t kWord = sizeof(std::uint64_t);
constexpr std::size_t kBlock = 8;            // words of a cache line
constexpr std::size_t kAhead = 32 * kBlock;  // words

std::uint64_t private_word(const void* from, std::size_t i) noexcept {
  std::uint64_t word;
  std::memcpy(&word, static_cast<const std::byte*>(from) + i * kWord, kWord);
  return word;
}

void set_private_word(void* to, std::size_t i, std::uint64_t word) noexcept {
  std::memcpy(static_cast<std::byte*>(to) + i * kWord, &word, kWord);
}

/// Single words keep too few cache lines under way: asking for them early is what makes this as fast as
/// memcpy.
void fetch_ahead(const void* from, const void* to, std::size_t i) noexcept {
  __builtin_prefetch(static_cast<const std::byte*>(from) + (i + kAhead) * kWord, 0);
  __builtin_prefetch(static_cast<const std::byte*>(to) + (i + kAhead) * kWord, 1);
}

/// `copy(i)` for every word, cache line by cache line. The compiler unrolls the inner loop.
template <class CopyWord>
void for_each_word(const void* to, const void* from, std::size_t words, const CopyWord& copy) noexcept {
  std::size_t i = 0;
  for (; i + kBlock <= words; i += kBlock) {
    if (i + kAhead < words) fetch_ahead(from, to, i);
#pragma GCC unroll 8
    for (std::size_t j = 0; j < kBlock; ++j) copy(i + j);
  }
  for (; i < words; ++i) copy(i);
}

}  // namespace

void copy_in(void* to, const void* from, std::size_t words) noexcept {
  auto* shared = static_cast<std::uint64_t*>(to);
  for_each_word(to, from, words, [=](std::size_t i) { store(shared[i], private_word(from, i)); });
}

void copy_in(void* to, const void* from, std::size_t words, Checksum& sum) noexcept {
  auto* shared = static_cast<std::uint64_t*>(to);
  Checksum running = sum;
  for_each_word(to, from, words, [&running, shared, from](std::size_t i) {
    const std::uint64_t word = private_word(from, i);
    running.add(word);
    store(shared[i], word);
  });
  sum = running;
}

void copy_out(void* to, const void* from, std::size_t words) noexcept {
  const auto* shared = static_cast<const std::uint64_t*>(from);
  for_each_word(to, from, words, [=](std::size_t i) { set_private_word(to, i, load(shared[i])); });
}

void copy_out(void* to, const void* from, std::size_t words, Checksum& sum) noexcept {
  const auto* shared = static_cast<const std::uint64_t*>(from);
  Checksum running = sum;
  for_each_word(to, from, words, [&running, shared, to](std::size_t i) {
    const std::uint64_t word = load(shared[i]);
    running.add(word);
    set_private_word(to, i, word);
  });
  sum = running;
}

}  // namespace linescope::shared
