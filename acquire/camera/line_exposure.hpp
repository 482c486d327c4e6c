// Exposure for the laser line, not for the picture, and what to say about the laser's brightness.
//
// A camera's own automatic exposure makes the tissue look right; the line is then burnt out (a saturated core
// has no middle) or too dim. Here the line itself is the measure. The laser of the thesis is set by hand at
// its supply, so that what the camera cannot reach becomes a hint to raise or lower it. Plain numbers in and
// out: no camera, no extractor.
#pragma once

#include <cstdint>
#include <string_view>

#include "common/result.hpp"

namespace linescope {

/// What one picture says about the line's light.
struct LineLight {
  double found = 0;      ///< share of the profiles (picture columns) in which the line was found, 0..1
  double saturated = 0;  ///< share of those with a saturated core, 0..1
  double peak = 0;       ///< median height of the line, grey levels 0..255
};

/// One figure for a bar on screen, 0..1: share of the profiles that carry an unsaturated line, times how far
/// the peak is up to the target (1 above it).
double line_quality(const LineLight& light, double target_peak);

enum class LaserHint : std::uint8_t {
  fine,
  raise,  ///< too dim even at the longest exposure
  lower,  ///< burnt out even at the shortest exposure
};
std::string_view name(LaserHint hint);

struct LineExposureOptions {
  double min_exposure_ms = 0.1;  ///< what the camera can do
  double max_exposure_ms = 20;   ///< longer smears the line of a moving hand: 50 mm/s x 20 ms = 1 mm
  double target_peak = 180;  ///< grey levels: below clipping by 30 % so that specular tissue keeps a middle
  double low_peak = 110;     ///< below it the line counts as dim and the exposure rises
  double high_peak = 225;    ///< above it the exposure falls before anything saturates
  double max_saturated = 0.05;  ///< share of burnt-out profiles that is put up with
  double min_found = 0.05;      ///< a line found in fewer profiles says nothing about its light
  double largest_step = 2;      ///< factor by which one step may change the exposure
  int settle_pictures = 4;      ///< a camera answers some pictures later: nothing is changed meanwhile
};
Result<void> validate(const LineExposureOptions& options);

struct ExposureAdvice {
  double exposure_ms = 0;  ///< what to set; the old value when nothing is to be changed
  LaserHint hint = LaserHint::fine;
  std::string_view reason;  ///< for people: why, "line burnt out", "line dim", "no line", "line good"
};

/// One step. A pure function: same numbers, same advice. Inside the band (low_peak..high_peak, few saturated)
/// nothing changes, so that it cannot hunt.
ExposureAdvice advise_exposure(const LineLight& light, double exposure_ms,
                               const LineExposureOptions& options);

/// The hint alone, for cameras whose exposure cannot be set.
LaserHint laser_hint(const LineLight& light, const LineExposureOptions& options);

/// advise_exposure() picture after picture: waits until a change has arrived in the pictures, and keeps a
/// hint standing until the opposite or a good line was seen for settle_pictures in a row (no flicker).
class LineExposureController {
 public:
  /// Precondition: validate(options) holds.
  LineExposureController(const LineExposureOptions& options, double exposure_ms);

  /// Call once per picture. `advice().exposure_ms` is what the camera should have now.
  const ExposureAdvice& update(const LineLight& light);
  const ExposureAdvice& advice() const { return advice_; }

  /// The exposure was set by somebody else, or the camera took another value than was asked.
  void exposure_is(double exposure_ms);

  /// False: the exposure stays as it is, only the hint follows the light.
  void may_change(bool yes) { may_change_ = yes; }

  /// True while the pictures may still be those of the exposure before.
  bool settling() const { return settling_ > 0; }

  /// The camera has `exposure_ms` although another one was asked: that is as far as it goes in this
  /// direction.
  void limited_to(double exposure_ms);

 private:
  void show(LaserHint hint);

  LineExposureOptions options_;
  ExposureAdvice advice_;
  bool may_change_ = true;
  int settling_ = 0;
  LaserHint coming_ = LaserHint::fine;
  int seen_ = 0;  ///< pictures in a row that gave `coming_`
};

}  // namespace linescope
