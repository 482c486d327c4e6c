// Where each section of a segment lies: computed by the writer from its options, checked by the reader from
// the header.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "common/result.hpp"
#include "ipc/segment_layout.h"
#include "ipc/segment_options.hpp"

namespace linescope {

inline constexpr std::size_t kSectionKinds = LS_SECTION_LATENCIES + 1;  ///< kinds are 1 .. kSectionKinds - 1

struct SegmentPlan {
  std::array<ls_section, kSectionKinds> sections{};  ///< by kind; element 0 is unused
  std::uint64_t total_bytes = 0;

  const ls_section& operator[](ls_section_kind kind) const { return sections[kind]; }
};

/// Options must be valid.
SegmentPlan plan_segment(const SegmentOptions& options);

/// The plan a header describes. Everything in it that is used later as a size, an offset or an index is
/// checked against `mapped_bytes`; `unreadable` with one sentence otherwise. `header` is a private copy.
Result<SegmentPlan> checked_plan(const ls_header& header, std::uint64_t mapped_bytes);

/// Distance of two rows of a picture in the segment.
constexpr std::uint32_t picture_stride(std::uint32_t width, std::uint32_t bytes_per_pixel) {
  return (width * bytes_per_pixel + 7U) / 8U * 8U;
}

}  // namespace linescope
