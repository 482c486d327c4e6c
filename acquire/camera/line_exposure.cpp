#include "acquire/camera/line_exposure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace linescope {
namespace {

enum class Light { good, dim, bright, burnt_out, absent };

Light judged(const LineLight& light, const LineExposureOptions& options) {
  if (!(light.found >= options.min_found)) return Light::absent;
  if (light.saturated > options.max_saturated) return Light::burnt_out;
  if (light.peak > options.high_peak) return Light::bright;
  return light.peak < options.low_peak ? Light::dim : Light::good;
}

std::string_view words(Light light) {
  switch (light) {
    case Light::good:
      return "line good";
    case Light::dim:
      return "line dim";
    case Light::bright:
      return "line nearly burnt out";
    case Light::burnt_out:
      return "line burnt out";
    case Light::absent:
      break;
  }
  return "no line";
}

/// Factor towards the target. The sensor is linear below clipping; a clipped peak only says "less", so the
/// more is burnt out, the larger the step. Without any line the exposure creeps up: darkness is the likelier
/// reason.
double factor(Light kind, const LineLight& light, const LineExposureOptions& options) {
  const double limit = options.largest_step;
  switch (kind) {
    case Light::dim:
    case Light::bright:
      return std::clamp(options.target_peak / std::max(light.peak, 1.0), 1 / limit, limit);
    case Light::burnt_out:
      return std::max(1 / limit, 1 / (1.1 + light.saturated * (limit - 1.1)));
    case Light::absent:
      return std::sqrt(limit);
    case Light::good:
      break;
  }
  return 1;
}

LaserHint hint_for(Light kind) {
  if (kind == Light::burnt_out) return LaserHint::lower;
  return kind == Light::dim || kind == Light::absent ? LaserHint::raise : LaserHint::fine;
}

}  // namespace

double line_quality(const LineLight& light, double target_peak) {
  const double height = std::clamp(light.peak / target_peak, 0.0, 1.0);
  return std::clamp(light.found, 0.0, 1.0) * std::clamp(1 - light.saturated, 0.0, 1.0) * height;
}

std::string_view name(LaserHint hint) {
  switch (hint) {
    case LaserHint::fine:
      return "laser fine";
    case LaserHint::raise:
      return "raise laser";
    case LaserHint::lower:
      return "lower laser";
  }
  return "unknown";
}

Result<void> validate(const LineExposureOptions& o) {
  if (!(o.min_exposure_ms > 0 && o.min_exposure_ms < o.max_exposure_ms && o.max_exposure_ms <= 10'000)) {
    return fail(ErrorCode::invalid, fmt::format("exposures from {} to {} ms are not a rising range above 0",
                                                o.min_exposure_ms, o.max_exposure_ms));
  }
  if (!(o.low_peak > 0 && o.low_peak < o.target_peak && o.target_peak < o.high_peak && o.high_peak < 255)) {
    return fail(ErrorCode::invalid, fmt::format("peaks {} < {} < {} must rise between 0 and 255", o.low_peak,
                                                o.target_peak, o.high_peak));
  }
  if (!(o.max_saturated >= 0 && o.max_saturated < 1 && o.min_found > 0 && o.min_found <= 1)) {
    return fail(ErrorCode::invalid,
                fmt::format("shares of saturated ({}) and found ({}) profiles must be between 0 and 1",
                            o.max_saturated, o.min_found));
  }
  if (!(o.largest_step > 1.2 && o.largest_step <= 16)) {
    return fail(ErrorCode::invalid,
                fmt::format("a largest step of {} is not between 1.2 and 16", o.largest_step));
  }
  if (o.settle_pictures < 0 || o.settle_pictures > 1000) {
    return fail(ErrorCode::invalid,
                fmt::format("{} pictures to settle are not between 0 and 1000", o.settle_pictures));
  }
  return {};
}

ExposureAdvice advise_exposure(const LineLight& light, double exposure_ms,
                               const LineExposureOptions& options) {
  const Light kind = judged(light, options);
  const double wanted = exposure_ms * factor(kind, light, options);
  const double reached = std::clamp(wanted, options.min_exposure_ms, options.max_exposure_ms);
  const bool stuck = reached == std::clamp(exposure_ms, options.min_exposure_ms, options.max_exposure_ms);
  return {reached, stuck ? hint_for(kind) : LaserHint::fine, words(kind)};
}

LaserHint laser_hint(const LineLight& light, const LineExposureOptions& options) {
  return hint_for(judged(light, options));
}

LineExposureController::LineExposureController(const LineExposureOptions& options, double exposure_ms)
    : options_(options) {
  exposure_is(exposure_ms);
}

void LineExposureController::exposure_is(double exposure_ms) {
  advice_.exposure_ms = std::clamp(exposure_ms, options_.min_exposure_ms, options_.max_exposure_ms);
  settling_ = options_.settle_pictures;
}

const ExposureAdvice& LineExposureController::update(const LineLight& light) {
  if (settling_ > 0) {
    --settling_;
    return advice_;
  }
  ExposureAdvice step = advise_exposure(light, advice_.exposure_ms, options_);
  if (!may_change_) {
    step.exposure_ms = advice_.exposure_ms;
    step.hint = laser_hint(light, options_);
  }
  show(step.hint);
  advice_.reason = step.reason;
  if (step.exposure_ms != advice_.exposure_ms) exposure_is(step.exposure_ms);
  return advice_;
}

void LineExposureController::limited_to(double exposure_ms) {
  const bool too_short = exposure_ms < advice_.exposure_ms;
  if (too_short && exposure_ms > options_.min_exposure_ms) options_.max_exposure_ms = exposure_ms;
  if (!too_short && exposure_ms < options_.max_exposure_ms) options_.min_exposure_ms = exposure_ms;
  exposure_is(exposure_ms);
}

void LineExposureController::show(LaserHint hint) {
  seen_ = hint == coming_ ? seen_ + 1 : 1;
  coming_ = hint;
  if (seen_ > options_.settle_pictures) advice_.hint = hint;
}

}  // namespace linescope
