// What the vector versions of the first look share. Internal to acquire/laser.
//
// Channels are never separated: around the byte of the laser's leading channel, the other two are loads one
// or two bytes away, and only every third lane of the result means something.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "acquire/laser/line_mask.hpp"
#include "acquire/laser/line_mask_detail.hpp"

namespace linescope::mask_detail {

inline constexpr std::ptrdiff_t kGroupBytes = 3 * kMaskGroup;

constexpr int lead_of(unsigned on) {
  return leading_channel(static_cast<LaserColour>(on));
}

/// Bytes from the leading channel to channel `c` of the same pixel.
constexpr std::ptrdiff_t from_lead(unsigned on, int c) {
  return c - lead_of(on);
}

/// Of `Bits` bytes that start `offset` bytes after a pixel's first: those that hold channel `lead`, as bits.
template <class Bits>
constexpr Bits lanes_of(int lead, int offset) {
  Bits lanes = 0;
  for (int i = 0; i < static_cast<int>(8 * sizeof(Bits)); ++i)
    if ((offset + i) % 3 == lead) lanes |= Bits{1} << i;
  return lanes;
}

/// Bytes ahead of the marker that are asked from memory: far enough to arrive in time, and only a few
/// kilobytes too many.
inline constexpr std::ptrdiff_t kPrefetch = 4096;

/// Groups [from, to) of a row see the same sides.
struct Stretch {
  int from = 0, to = 0;
};

/// `Marker::row<On, Ridge>` marks whole groups of a stretch and says how many it did; the plain version does
/// the others.
template <class Marker, unsigned On, bool Ridge>
void mark_row_by(const PictureView& p, const MaskRule& rule, int y, std::uint32_t* words) {
  const bool along = Ridge && rule.axis == ProfileAxis::row;
  const bool reaches_down = Ridge && !along && y + rule.reach < p.height;
  const bool reaches_up = Ridge && !along && y >= rule.reach;
  // Vectors read up to two bytes before and behind their group: harmless except at the picture's first and
  // last byte.
  const int deepest = reaches_down ? y + rule.reach : y, highest = reaches_up ? y - rule.reach : y;
  const int begin = highest == 0 ? 1 : 0, end = p.width / kMaskGroup - (deepest >= p.height - 1 ? 1 : 0);
  const int left = along ? (rule.reach + kMaskGroup - 1) / kMaskGroup : begin;
  const int right = along ? (p.width - rule.reach - 1) / kMaskGroup : end;
  const auto inside = [&](int group) { return std::clamp(group, begin, std::max(begin, end)); };
  const int a = inside(left), b = std::max(a, inside(right));
  const std::array stretches{Stretch{begin, a}, Stretch{a, b}, Stretch{b, std::max(b, end)}};
  int done = 0;
  for (const Stretch s : stretches) {
    for (; done < s.from; ++done) words[done] = mark_group(p, rule, y, done * kMaskGroup);
    if (s.from >= s.to) continue;
    const Sides sides = sides_of_group(p, rule, y, s.from * kMaskGroup);
    if (Ridge && !sides.any()) continue;
    done += Marker::template row<On, Ridge>(p.data + p.stride * y + kGroupBytes * s.from, rule, sides,
                                            s.to - s.from, words + s.from);
  }
  for (; done < mask_words(p.width); ++done) words[done] = mark_group(p, rule, y, done * kMaskGroup);
}

template <class Marker, unsigned On>
RowMarker row_marker_for(const MaskRule& rule) {
  return rule.ridge() ? &mark_row_by<Marker, On, true> : &mark_row_by<Marker, On, false>;
}

template <class Marker>
RowMarker row_marker_of(const MaskRule& rule) {
  switch (rule.on) {
    case 1:
      return row_marker_for<Marker, 1>(rule);
    case 2:
      return row_marker_for<Marker, 2>(rule);
    case 3:
      return row_marker_for<Marker, 3>(rule);
    case 4:
      return row_marker_for<Marker, 4>(rule);
    case 5:
      return row_marker_for<Marker, 5>(rule);
    case 6:
      return row_marker_for<Marker, 6>(rule);
    default:
      return row_marker_for<Marker, 7>(rule);
  }
}

}  // namespace linescope::mask_detail
