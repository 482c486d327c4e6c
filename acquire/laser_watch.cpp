#include "acquire/laser_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace linescope {
namespace {

/// A camera's steps are coarse: what lies within this is the value that was asked.
constexpr double kSameExposure = 0.06;

constexpr double kFirstExposure = 5;  // ms

double start_value(const LineExposureOptions& options, double exposure_ms) {
  return exposure_ms > 0 ? exposure_ms
                         : std::clamp(kFirstExposure, options.min_exposure_ms, options.max_exposure_ms);
}

}  // namespace

LineLight line_light(const ExtractedLine& line, std::vector<float>& scratch) {
  LineLight light;
  const auto good = static_cast<double>(line.samples.size());
  const double burnt_away = line.count(NoPoint::saturated);
  const double found = good + burnt_away;
  if (found <= 0 || line.profiles() <= 0) return light;
  light.found = std::min(1.0, found / line.profiles());
  light.saturated = (good * static_cast<double>(line.saturated_fraction) + burnt_away) / found;
  light.peak = 255;
  if (line.samples.empty()) return light;
  scratch.clear();
  for (const LineSample& sample : line.samples) scratch.push_back(sample.peak);
  const auto middle = scratch.begin() + static_cast<std::ptrdiff_t>(scratch.size() / 2);
  std::nth_element(scratch.begin(), middle, scratch.end());
  light.peak = static_cast<double>(*middle);
  return light;
}

LaserWatch::LaserWatch(const LineExposureOptions& options, double exposure_ms, CameraSource& camera)
    : options_(options), camera_(camera), controller_(options, start_value(options, exposure_ms)) {
  automatic_ = exposure_ms == 0 && camera_.live();
  controller_.may_change(automatic_);
  asked_ms_ = controller_.advice().exposure_ms;
  scratch_.reserve(16384);
}

void LaserWatch::look(const ExtractedLine& line) {
  seen_ = true;
  light_ = line_light(line, scratch_);
  controller_.update(light_);
  if (automatic_) follow();
}

void LaserWatch::follow() {
  const double wanted = controller_.advice().exposure_ms;
  if (wanted == asked_ms_) return;
  asked_ms_ = wanted;
  if (camera_.set_exposure(wanted)) return;
  automatic_ = false;  // no such control: the hint is all that can be given
  controller_.may_change(false);
}

void LaserWatch::camera_has(double exposure_ms) {
  camera_ms_ = exposure_ms;
  if (!automatic_ || exposure_ms <= 0 || controller_.settling()) return;
  if (std::abs(exposure_ms - asked_ms_) <= kSameExposure * asked_ms_) return;
  controller_.limited_to(exposure_ms);
  asked_ms_ = controller_.advice().exposure_ms;
}

Result<void> LaserWatch::expose(double exposure_ms) {
  if (exposure_ms != 0) {
    if (auto set = camera_.set_exposure(exposure_ms); !set) return set;
    automatic_ = false;
  } else if (camera_.live()) {
    controller_ = LineExposureController(options_, camera_ms_ > 0 ? camera_ms_ : asked_ms_);
    automatic_ = true;
  } else {
    return camera_.set_exposure(kFirstExposure);  // its own words why not
  }
  controller_.may_change(automatic_);
  asked_ms_ = exposure_ms != 0 ? exposure_ms : controller_.advice().exposure_ms;
  controller_.exposure_is(asked_ms_);
  return {};
}

void LaserWatch::describe(std::string& text) const {
  text.clear();
  if (!seen_) return;
  fmt::format_to(std::back_inserter(text), "line quality {:.2f}, {:.0f} % burnt out",
                 line_quality(light_, options_.target_peak), 100 * light_.saturated);
  const ExposureAdvice& advice = controller_.advice();
  if (advice.hint == LaserHint::fine) return;
  fmt::format_to(std::back_inserter(text), "; {} the laser: {}",
                 advice.hint == LaserHint::raise ? "raise" : "lower", advice.reason);
}

}  // namespace linescope
