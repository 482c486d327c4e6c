// Sections of a mapped segment, and the one rule by which a ring is read: copy, then look whether the writer
// may have been there.
#pragma once

#include <cstddef>
#include <cstdint>

#include "ipc/segment_layout.h"
#include "ipc/segment_plan.hpp"
#include "ipc/shared_words.hpp"

namespace linescope::shared {

/// One ring in a mapping; `Byte` is const for readers. Places are always inside of the mapping, whatever head
/// says.
template <class Byte>
class Ring {
 public:
  Ring(Byte* segment, const ls_section& section, std::uint32_t ring)
      : start_(segment + section.offset + section.ring_bytes * ring),
        record_bytes_(section.record_bytes),
        record_count_(section.record_count) {}

  auto& head() const { return as<ls_ring>(start_).head; }
  std::uint32_t capacity() const { return record_count_; }
  std::size_t record_bytes() const { return record_bytes_; }
  Byte* place(std::uint64_t index) const {
    return start_ + sizeof(ls_ring) + std::size_t{record_bytes_} * (index % record_count_);
  }
  /// Whether a copy of record `index`, taken before this call, is whole.
  bool intact(std::uint64_t index) const { return load(head()) - index < record_count_; }

  template <class T>
  static auto& as(Byte* at) {
    using Target = std::conditional_t<std::is_const_v<Byte>, const T, T>;
    return *reinterpret_cast<Target*>(at);
  }

 private:
  Byte* start_;
  std::uint32_t record_bytes_;
  std::uint32_t record_count_;
};

using RingIn = Ring<std::byte>;
using RingOut = Ring<const std::byte>;

/// The writer's end of a ring: one thread.
class RingWriter {
 public:
  RingWriter(std::byte* segment, const ls_section& section, std::uint32_t ring = 0)
      : ring_(segment, section, ring) {}

  std::uint64_t next() const { return next_; }
  std::byte* place() const { return ring_.place(next_); }
  std::size_t record_bytes() const { return ring_.record_bytes(); }

  /// What was written to place() becomes the newest record.
  void publish() { store(ring_.head(), ++next_); }

  template <class T>
  void publish(T& record) {
    record.index = next_;
    put(RingIn::as<T>(place()), record);
    publish();
  }

 private:
  RingIn ring_;
  std::uint64_t next_ = 0;
};

/// How often a copy is tried again before the reader is told that it was overtaken.
inline constexpr int kTries = 8;

}  // namespace linescope::shared
