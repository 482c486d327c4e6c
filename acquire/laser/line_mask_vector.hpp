// What the vector versions of the first look share. Internal to acquire/laser.
//
// Channels are never separated: around the byte of the laser's leading channel, the other two are loads one
// or two bytes away, and only every third lane of the result means something.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

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

/// One row on its way through the vectors.
struct MarkedRow {
  const std::uint8_t* pixels = nullptr;
  Sides sides;
  std::uint32_t* words = nullptr;
  std::ptrdiff_t ahead = 0;  ///< bytes from here to what memory should bring next
};

/// Bytes ahead of the marker that are asked from memory: far enough to arrive in time.
inline constexpr std::ptrdiff_t kPrefetch = 1024;

/// Rows that are marked together, a few groups of one after a few of the next. They lie far apart:
/// memory that is asked for at several places at once delivers much faster than at one.
inline constexpr int kRowsAtOnce = 4;

/// Groups of a row: the vectors do [begin, end), and within each of the three stretches, which end at `left`,
/// `right` and `end`, all groups see the same sides.
struct RowPlan {
  int begin = 0, left = 0, right = 0, end = 0;
  bool operator==(const RowPlan&) const = default;
};

inline RowPlan plan_of_row(const PictureView& p, const MaskRule& rule, int y) {
  const bool along = rule.ridge() && rule.axis == ProfileAxis::row, across = rule.ridge() && !along;
  // Vectors read up to two bytes before and behind their group: harmless except at the picture's first and
  // last byte.
  const int deepest = across && y + rule.reach < p.height ? y + rule.reach : y;
  const int highest = across && y >= rule.reach ? y - rule.reach : y;
  RowPlan plan;
  plan.begin = highest == 0 ? 1 : 0;
  plan.end = std::max(plan.begin, p.width / kMaskGroup - (deepest >= p.height - 1 ? 1 : 0));
  plan.left =
      along ? std::clamp((rule.reach + kMaskGroup - 1) / kMaskGroup, plan.begin, plan.end) : plan.begin;
  plan.right = along ? std::clamp((p.width - rule.reach - 1) / kMaskGroup, plan.left, plan.end) : plan.end;
  return plan;
}

/// Rows from which on the first kPrefetch bytes are worth asking for; shorter ones are asked for by those
/// before.
inline constexpr int kLongRow = 4 * kPrefetch;

/// Asks memory for what lies before the places from which on the marker does so itself.
inline void fetch_begin(std::span<const MarkedRow> rows) {
  for (std::ptrdiff_t before = kPrefetch; before > 0; before -= 64)
    for (const MarkedRow& row : rows) __builtin_prefetch(row.pixels + row.ahead - before);
}

/// `Vectors::mark<On, Ridge>` marks whole groups of a stretch of all rows and says how many of each it did;
/// the plain version does the others.
template <class Vectors, unsigned On, bool Ridge>
void mark_rows_by(const PictureView& p, const MaskRule& rule, const RowPlan& plan, std::span<const int> ys,
                  std::uint32_t* words) {
  const std::ptrdiff_t row_words = mask_words(p.width);
  int done = 0;
  const auto plainly = [&](int to) {
    for (const int y : ys)
      for (int group = done; group < to; ++group)
        words[y * row_words + group] = mark_group(p, rule, y, group * kMaskGroup);
    done = to;
  };
  std::array<MarkedRow, kRowsAtOnce> rows;
  int from = plan.begin;
  for (const int to : {plan.left, plan.right, plan.end}) {
    plainly(from);
    bool sides = true;
    for (std::size_t i = 0; i < ys.size(); ++i) {
      rows[i] = {p.data + p.stride * ys[i] + kGroupBytes * from,
                 sides_of_group(p, rule, ys[i], from * kMaskGroup), words + ys[i] * row_words + from};
      rows[i].ahead = kPrefetch + std::max<std::ptrdiff_t>(rows[i].sides.after, 0);
      sides = sides && rows[i].sides.any();
    }
    if (from < to && p.width >= kLongRow) fetch_begin({rows.data(), ys.size()});
    if (from < to && (!Ridge || sides))
      done += Vectors::template mark<On, Ridge>({rows.data(), ys.size()}, rule, to - from);
    from = std::max(from, to);
  }
  plainly(mask_words(p.width));
}

/// How far the rows lie apart that are marked together: an equal share of the picture, or as far as a ridge
/// test across them looks, so that each row's sides are among the others.
inline int rows_apart(const PictureView& p, const MaskRule& rule) {
  const int share = std::max(1, p.height / kRowsAtOnce);
  return rule.ridge() && rule.axis == ProfileAxis::column ? std::min(rule.reach, share) : share;
}

/// What all rows can do alike; the rest of each is left to the plain version.
inline RowPlan common_plan(const PictureView& p, const MaskRule& rule, std::span<const int> ys) {
  RowPlan common = plan_of_row(p, rule, ys[0]);
  for (const int y : ys.subspan(1)) {
    const RowPlan plan = plan_of_row(p, rule, y);
    common = {std::max(common.begin, plan.begin), std::max(common.left, plan.left),
              std::min(common.right, plan.right), std::min(common.end, plan.end)};
  }
  return common;
}

/// Rows [from, to).
template <class Vectors, unsigned On, bool Ridge>
void mark_between(const PictureView& p, const MaskRule& rule, int from, int to, std::uint32_t* words) {
  const int apart = rows_apart(p, rule);
  std::array<int, kRowsAtOnce> ys{};
  for (int y = from; y < to;) {
    const int left = to - y, together = std::clamp(left / apart, 1, kRowsAtOnce);
    const int rows = std::min(apart, left);
    for (int row = y; row < y + rows; ++row) {
      for (int i = 0; i < together; ++i) ys[static_cast<std::size_t>(i)] = row + i * apart;
      const std::span<const int> chosen(ys.data(), static_cast<std::size_t>(together));
      mark_rows_by<Vectors, On, Ridge>(p, rule, common_plan(p, rule, chosen), chosen, words);
    }
    y += rows * together;
  }
}

/// The picture with all rows between one and the next that is marked with it as one long row.
struct Folded {
  PictureView picture;
  MaskRule rule;
  int rows = 0;  ///< of the picture in one long row
  int to = 0;    ///< long rows that can be marked as such
};

/// Possible where rows follow one another without a gap and nothing is asked of pixels in the same row. A
/// long row must be full, and have all of the next below it or nothing.
inline Folded folded(const PictureView& p, const MaskRule& rule) {
  const bool along = rule.ridge() && rule.axis == ProfileAxis::row, across = rule.ridge() && !along;
  const int rows = rows_apart(p, rule), full = p.height / rows;
  if (along || (across && rows != rule.reach) || p.stride != 3 * p.width || p.width % kMaskGroup != 0)
    return {p, rule, 1, 0};
  Folded f{p, rule, rows, across && full * rows != p.height ? full - 1 : full};
  f.picture.stride *= rows;
  f.picture.width *= rows;
  f.picture.height = full;
  f.rule.reach = 1;
  return f;
}

template <class Vectors, unsigned On, bool Ridge>
void mark_picture_by(const PictureView& p, const MaskRule& rule, std::uint32_t* words) {
  const Folded f = folded(p, rule);
  mark_between<Vectors, On, Ridge>(f.picture, f.rule, 0, f.to, words);
  mark_between<Vectors, On, Ridge>(p, rule, f.to * f.rows, p.height, words);
}

template <class Vectors, unsigned On>
Marker marker_for(const MaskRule& rule) {
  return rule.ridge() ? &mark_picture_by<Vectors, On, true> : &mark_picture_by<Vectors, On, false>;
}

template <class Vectors>
Marker marker_of(const MaskRule& rule) {
  switch (rule.on) {
    case 1:
      return marker_for<Vectors, 1>(rule);
    case 2:
      return marker_for<Vectors, 2>(rule);
    case 3:
      return marker_for<Vectors, 3>(rule);
    case 4:
      return marker_for<Vectors, 4>(rule);
    case 5:
      return marker_for<Vectors, 5>(rule);
    case 6:
      return marker_for<Vectors, 6>(rule);
    default:
      return marker_for<Vectors, 7>(rule);
  }
}

}  // namespace linescope::mask_detail
