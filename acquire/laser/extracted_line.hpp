// The laser line found in one picture, and what became of every profile in which none was found.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

#include "acquire/laser/line_extractor_options.hpp"

namespace linescope {

/// One point of the line. Pixels: u right, v down, the centre of the first pixel is (0, 0).
struct LineSample {
  float u = 0;
  float v = 0;
  float width = 0;      ///< px, standard deviation of the profile (a Gaussian's sigma)
  float peak = 0;       ///< grey levels above the local background, 0..255
  float snr = 0;        ///< peak over the noise of this picture's background
  float saturated = 0;  ///< px of saturated plateau
  float second =
      std::numeric_limits<float>::quiet_NaN();  ///< px along the profile: next best candidate, NaN if none
  float second_ratio = 0;  ///< support of the second candidate over that of this one, 0..1
};

/// Why a candidate was rejected, and why a profile (column or row) gave no point.
enum class NoPoint : std::uint8_t {
  no_light,      ///< nothing bright or coloured enough to look at
  wrong_colour,  ///< a bright streak, but not of the laser's colour
  too_dim,       ///< below min_snr or relative_threshold
  too_narrow,    ///< a speck: narrower than min_width
  too_wide,      ///< a glow or an object: wider than max_width
  saturated,     ///< plateau longer than max_saturated
  at_border,     ///< the line leaves the picture here
  isolated,      ///< no neighbours to make it a line
  ambiguous,     ///< two candidates of about the same support
  bad_picture,   ///< empty, or not 8-bit BGR or grey
};
inline constexpr std::size_t kNoPointReasons = 10;

/// For people and log lines, for example "too wide".
std::string_view name(NoPoint reason);

using NoPointCounts = std::array<std::uint32_t, kNoPointReasons>;

struct ExtractedLine {
  int width = 0;   ///< of the picture, px
  int height = 0;  ///< px
  ProfileAxis axis = ProfileAxis::column;
  std::vector<LineSample> samples;  ///< in the order of the profiles; at most one each

  /// Every profile of the picture is either a sample or counted here once, under the fault of its best
  /// candidate.
  NoPointCounts no_point{};
  /// Every rejected candidate, also those of profiles that gave a point.
  NoPointCounts rejected_candidates{};
  std::uint32_t crowded = 0;      ///< candidates not looked at because their profile had too many
  std::uint32_t with_second = 0;  ///< samples that have a second candidate
  float noise = 0;                ///< grey levels, standard deviation of the background beside the line
  float mean_snr = 0;             ///< of the samples
  float saturated_fraction = 0;   ///< samples with a saturated pixel / samples: for the exposure

  std::uint32_t count(NoPoint reason) const { return no_point[static_cast<std::size_t>(reason)]; }
  int profiles() const { return axis == ProfileAxis::column ? width : height; }
};

}  // namespace linescope
