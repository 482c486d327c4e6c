#include "tests/support/allocation_counter.hpp"

#include <atomic>
#include <cstdlib>
#include <new>

namespace {

thread_local std::size_t here = 0;
std::atomic<std::size_t> everywhere{0};

void* counted(std::size_t size) noexcept {
  ++here;
  ++everywhere;
  return std::malloc(size == 0 ? 1 : size);
}

void* counted_or_thrown(std::size_t size) {
  if (void* memory = counted(size)) return memory;
  throw std::bad_alloc();
}

}  // namespace

std::size_t linescope::testing::allocations_here() {
  return here;
}
std::size_t linescope::testing::allocations_everywhere() {
  return everywhere;
}

// All of them: where one is missing, a sanitizer's own takes its place and does not know our memory.
[[gnu::noinline]] void* operator new(std::size_t size) {
  return counted_or_thrown(size);
}
[[gnu::noinline]] void* operator new[](std::size_t size) {
  return counted_or_thrown(size);
}
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return counted(size);
}
[[gnu::noinline]] void* operator new[](std::size_t size, const std::nothrow_t&) noexcept {
  return counted(size);
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete[](void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete[](void* memory, std::size_t) noexcept {
  std::free(memory);
}
