#include "ipc/segment_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "ipc/control_layout.h"
#include "ipc/segment_plan.hpp"

namespace linescope {
namespace {

constexpr std::size_t kLongestName = 64;

Result<void> check_name(const std::string& name) {
  const auto legal = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
           c == '_' || c == '-';
  };
  if (!name.empty() && name.size() <= kLongestName && name.front() != '.' &&
      std::all_of(name.begin(), name.end(), legal)) {
    return {};
  }
  return fail(ErrorCode::usage, fmt::format("\"{}\" is no name for a segment: use 1 to {} letters, digits, "
                                            "'.', '_' or '-', and no '.' in front",
                                            name, kLongestName));
}

struct Range {
  const char* what;
  std::uint32_t value, least, most;
};

Result<void> check_range(const Range& r) {
  if (r.value >= r.least && r.value <= r.most) return {};
  return fail(ErrorCode::usage,
              fmt::format("segment: {} is {}, but must be {} to {}", r.what, r.value, r.least, r.most));
}

}  // namespace

Result<void> validate(const SegmentOptions& o) {
  if (auto ok = check_name(o.name); !ok) return ok;
  const std::array ranges{Range{"point_capacity", o.point_capacity, 2, 4'000'000'000},
                          Range{"line_capacity", o.line_capacity, 1, 10'000'000},
                          Range{"points_per_line", o.points_per_line, 1, 1'000'000},
                          Range{"pose_history", o.pose_history, 2, 1'000'000},
                          Range{"picture_slots", o.picture_slots, 3, 64},
                          Range{"picture_bytes", o.picture_bytes, 64, 200'000'000},
                          Range{"picture_samples", o.picture_samples, 0, 100'000},
                          Range{"frame_history", o.frame_history, 2, 1'000'000},
                          Range{"text_bytes", o.text_bytes, 64, 100'000'000}};
  for (const Range& range : ranges) {
    if (auto ok = check_range(range); !ok) return ok;
  }
  return {};
}

std::size_t segment_bytes(const SegmentOptions& options) {
  return plan_segment(options).total_bytes;
}

std::string control_name(const std::string& segment_name) {
  return segment_name + "-control";
}

}  // namespace linescope
