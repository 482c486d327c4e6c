// What can be chosen about the extraction of the laser line.
#pragma once

#include <cstdint>

#include "acquire/laser/laser_colour.hpp"
#include "common/result.hpp"

namespace linescope {

/// Along what the picture is cut into profiles; every profile gives at most one point.
enum class ProfileAxis : std::uint8_t {
  column,  ///< one point per column: the line runs from left to right (the thesis's endoscope)
  row,     ///< one point per row: the line runs from top to bottom
};

/// As configuration files name them.
inline constexpr std::array<std::pair<const char*, ProfileAxis>, 2> kProfileAxisWords{
    {{"column", ProfileAxis::column}, {"row", ProfileAxis::row}}};

enum class CentreMethod : std::uint8_t {
  weighted_mean,   ///< mean position weighted with the colour excess above the threshold: the thesis (4.2.3)
  gauss_weighted,  ///< matched Gaussian on the laser's own channel: within a tenth of the Cramer-Rao bound
};

/// Grey levels are 0..255, lengths are pixels. Widths are full widths at half height.
struct LineExtractorOptions {
  LaserColour colour = LaserColour::green;
  ProfileAxis axis = ProfileAxis::column;
  CentreMethod centre = CentreMethod::gauss_weighted;

  // Where the line may be: a pixel is looked at when it passes one of two tests. One asks for colour excess
  // (laser_colour.hpp). The other asks for a ridge, brighter than both sides in the laser's channel; it finds
  // lines whose colour drowns in ambient light or in saturation, and is the only one for mono. The weighted
  // mean knows only the first.
  int colour_threshold = 24;  ///< grey levels of excess; 1..254
  int ridge_threshold =
      12;                ///< grey levels above both sides, more in noisy pictures; 0 switches it off; 0..254
  int ridge_reach = 24;  ///< px to the sides: at least twice the line's width; 2..256
  double colour_ratio =
      1.62;           ///< what a ridge adds is this much more laser-coloured than its surroundings; 1..10
  int merge_gap = 3;  ///< px; pieces of one profile closer than this are one candidate; 0..32
  int saturation_level = 245;  ///< grey levels from which a channel counts as saturated; 128..255

  // What a point of the line must look like.
  double min_width = 1.0;   ///< px; anything narrower is a speck
  double max_width = 80.0;  ///< px; anything broader is a glow or an object
  int max_saturated = 60;   ///< px; a longer saturated plateau hides where the middle is
  double min_snr = 4.0;     ///< peak above the background over the picture's noise
  double relative_threshold =
      0.05;        ///< peak over the picture's strong peaks (95th percentile); 0 for any; 0..0.95
  int border = 1;  ///< px; a line this close to the end of its profile may be cut off

  // What makes it a line: neighbours.
  int min_run = 8;          ///< profiles; a shorter connected piece is a glint
  double max_step = 4.0;    ///< px from one profile to the next within a piece
  int max_gap = 4;          ///< profiles that may be missing within a piece; 0..64
  double ambiguity = 0.95;  ///< a rival with more than this fraction of the support: ambiguous; 0.1..1
};

/// The first impossible value in one sentence.
Result<void> validate(const LineExtractorOptions& options);

}  // namespace linescope
