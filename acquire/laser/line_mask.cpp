#include "acquire/laser/line_mask.hpp"

#include <algorithm>
#include <array>

#include "acquire/laser/line_mask_detail.hpp"

namespace linescope {
namespace {

/// The tests of one group, without branches.
struct Tests {
  std::array<int, 3> unlit{};  ///< 255 for a channel in which the laser does not shine, else 0
  std::ptrdiff_t before = 0, after = 0;
  int lead = 0, colour_threshold = 256, ridge_threshold = 256;

  /// A dark channel counts as 255 among the lit ones, a lit one as 0 among the dark ones.
  int excess(const std::uint8_t* bgr) const {
    const auto [d0, d1, d2] = unlit;
    const int b = bgr[0], g = bgr[1], r = bgr[2];
    return std::min(b | d0, std::min(g | d1, r | d2)) - std::max(b & d0, std::max(g & d1, r & d2));
  }
  bool pass(const std::uint8_t* pixel) const {
    const int around = std::max<int>(pixel[lead + before], pixel[lead + after]);
    const bool ridge = pixel[lead] - around >= ridge_threshold;
    return ridge | (excess(pixel) >= colour_threshold);
  }
};

Tests tests_of(const MaskRule& rule, const mask_detail::Sides& sides) {
  Tests t;
  for (std::size_t c = 0; c < 3; ++c) t.unlit[c] = (rule.on >> c & 1U) != 0 ? 0 : 255;
  t.before = sides.before;
  t.after = sides.after;
  t.lead = rule.lead;
  t.colour_threshold = rule.colour_threshold;
  if (sides.any()) t.ridge_threshold = rule.ridge_threshold;
  return t;
}

}  // namespace

namespace mask_detail {

Sides sides_of_group(const PictureView& p, const MaskRule& rule, int y, int x) {
  Sides s;
  if (!rule.ridge()) return s;
  const bool column = rule.axis == ProfileAxis::column;
  const std::ptrdiff_t offset = column ? p.stride * rule.reach : std::ptrdiff_t{p.channels} * rule.reach;
  const bool before = column ? y >= rule.reach : x >= rule.reach;
  // One pixel more than needed, so that whole vectors may be read there.
  const bool after = column ? y + rule.reach < p.height : x + kMaskGroup + 1 + rule.reach <= p.width;
  if (before || after) {
    s.before = before ? -offset : offset;
    s.after = after ? offset : -offset;
  }
  return s;
}

std::uint32_t mark_group(const PictureView& p, const MaskRule& rule, int y, int x) {
  const std::uint8_t* pixel = p.data + p.stride * y + std::ptrdiff_t{p.channels} * x;
  const Sides sides = sides_of_group(p, rule, y, x);
  const int n = std::min(kMaskGroup, p.width - x);
  std::uint32_t bits = 0;
  if (p.channels == 1) {
    for (int i = 0; i < n; ++i) {
      const bool ridge =
          sides.any() &&
          pixel[i] - std::max(pixel[i + sides.before], pixel[i + sides.after]) >= rule.ridge_threshold;
      bits |= std::uint32_t{ridge || pixel[i] >= rule.colour_threshold} << i;
    }
    return bits;
  }
  const Tests tests = tests_of(rule, sides);
  for (int i = 0; i < n; ++i) bits |= std::uint32_t{tests.pass(pixel + 3 * i)} << i;
  return bits;
}

}  // namespace mask_detail

MaskRule mask_rule(const LineExtractorOptions& options, int channels) {
  MaskRule rule;
  rule.on = channels == 1 ? static_cast<unsigned>(LaserColour::mono) : static_cast<unsigned>(options.colour);
  rule.lead = leading_channel(options.colour);
  rule.reach = options.ridge_reach;
  rule.axis = options.axis;
  const bool plain = options.centre == CentreMethod::weighted_mean || options.ridge_threshold == 0;
  rule.ridge_threshold = plain ? 256 : options.ridge_threshold;
  // Without colour the excess is the brightness itself, and a bright background would be one large mark.
  const bool colourless = rule.on == static_cast<unsigned>(LaserColour::mono);
  rule.colour_threshold = colourless && !plain ? 256 : options.colour_threshold;
  return rule;
}

void mark_picture(const PictureView& picture, const MaskRule& rule, std::uint32_t* words) {
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; x += kMaskGroup)
      *words++ = mask_detail::mark_group(picture, rule, y, x);
}

Marker fastest_marker(const PictureView& picture, const MaskRule& rule) {
  if (picture.channels != 3) return &mark_picture;
  if (const Marker m = mask_detail::avx512_marker(rule)) return m;
  if (const Marker m = mask_detail::avx2_marker(rule)) return m;
  return &mark_picture;
}

}  // namespace linescope
