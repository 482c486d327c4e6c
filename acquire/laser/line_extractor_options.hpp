// What can be chosen about the extraction of the laser line.
#pragma once

#include "acquire/laser/laser_colour.hpp"
#include "common/result.hpp"

namespace linescope {

/// Along what the picture is cut into profiles; every profile gives at most one point.
enum class ProfileAxis : std::uint8_t {
  column,  ///< one point per column: the line runs from left to right (the thesis's endoscope)
  row,     ///< one point per row: the line runs from top to bottom
};

enum class CentreMethod : std::uint8_t {
  weighted_mean,   ///< mean position weighted with the colour excess above the threshold: the thesis (4.2.3)
  gauss_weighted,  ///< matched Gaussian on the laser's intensity: within a tenth of the Cramer-Rao bound
};

/// Grey levels are 0..255, lengths are pixels.
struct LineExtractorOptions {
  LaserColour colour = LaserColour::green;
  ProfileAxis axis = ProfileAxis::column;
  CentreMethod centre = CentreMethod::gauss_weighted;

  // Where the line may be: segmentation by colour.
  int threshold = 24;  ///< grey levels of colour excess that a pixel of the line has at least; 1 .. 254
  double relative_threshold =
      0;  ///< and at least this fraction of the picture's largest excess; 0 switches it off; 0 .. 0.95
  int merge_gap = 3;  ///< px; runs of line pixels closer than this in a profile are one candidate
  int saturation_level =
      250;  ///< grey levels from which a channel counts as saturated; a white core bridges two runs

  // What a point of the line must look like.
  double min_width = 1.0;   ///< px; fewer pixels above half height are noise
  double max_width = 80.0;  ///< px; a broader band of light is no line
  int max_saturated = 60;   ///< px; a longer saturated plateau hides where the middle is
  double min_snr = 3.0;     ///< peak above background over the picture's noise
  int border = 2;           ///< px; a line closer than this to the end of its profile may be cut off

  // What makes it a line: neighbours.
  int min_run = 8;         ///< profiles; a shorter connected piece is a glint
  double max_step = 4.0;   ///< px from one profile to the next within one piece; a jump costs support
  double ambiguity = 0.9;  ///< a rival piece with more than this fraction of the support makes both unusable;
                           ///< 1 keeps the best
};

/// The first impossible value in one sentence.
Result<void> validate(const LineExtractorOptions& options);

}  // namespace linescope
