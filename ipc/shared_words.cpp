#include "ipc/shared_words.hpp"

namespace linescope::shared {
namespace {

constexpr std::size_t kWord = sizeof(std::uint64_t);

std::uint64_t private_word(const void* from, std::size_t i) noexcept {
  std::uint64_t word;
  std::memcpy(&word, static_cast<const std::byte*>(from) + i * kWord, kWord);
  return word;
}

void set_private_word(void* to, std::size_t i, std::uint64_t word) noexcept {
  std::memcpy(static_cast<std::byte*>(to) + i * kWord, &word, kWord);
}

}  // namespace

void copy_in(void* to, const void* from, std::size_t words) noexcept {
  auto* shared = static_cast<std::uint64_t*>(to);
  for (std::size_t i = 0; i < words; ++i) store(shared[i], private_word(from, i));
}

void copy_in(void* to, const void* from, std::size_t words, Checksum& sum) noexcept {
  auto* shared = static_cast<std::uint64_t*>(to);
  Checksum running = sum;
  for (std::size_t i = 0; i < words; ++i) {
    const std::uint64_t word = private_word(from, i);
    running.add(word);
    store(shared[i], word);
  }
  sum = running;
}

void copy_out(void* to, const void* from, std::size_t words) noexcept {
  const auto* shared = static_cast<const std::uint64_t*>(from);
  for (std::size_t i = 0; i < words; ++i) set_private_word(to, i, load(shared[i]));
}

void copy_out(void* to, const void* from, std::size_t words, Checksum& sum) noexcept {
  const auto* shared = static_cast<const std::uint64_t*>(from);
  Checksum running = sum;
  for (std::size_t i = 0; i < words; ++i) {
    const std::uint64_t word = load(shared[i]);
    running.add(word);
    set_private_word(to, i, word);
  }
  sum = running;
}

}  // namespace linescope::shared
