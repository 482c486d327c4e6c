#include "acquire/twin/hand_options.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

namespace linescope::twin {
namespace {

constexpr std::array<std::pair<Scenario, std::string_view>, 8> kNames{{{Scenario::demo, "demo"},
                                                                       {Scenario::sweeps, "sweeps"},
                                                                       {Scenario::spots, "spots"},
                                                                       {Scenario::still, "still"},
                                                                       {Scenario::board, "board"},
                                                                       {Scenario::shake, "shake"},
                                                                       {Scenario::pivot, "pivot"},
                                                                       {Scenario::spin, "spin"}}};

}  // namespace

Result<Scenario> scenario_from_name(std::string_view wanted) {
  for (const auto& [scenario, text] : kNames) {
    if (text == wanted) return scenario;
  }
  return fail(ErrorCode::usage,
              fmt::format("no scenario is called '{}': use demo, sweeps, spots or still, and to "
                          "calibrate board, shake, pivot or spin",
                          wanted));
}

std::string_view name(Scenario scenario) {
  for (const auto& [known, text] : kNames) {
    if (known == scenario) return text;
  }
  return "unknown";
}

Result<void> validate(const HandOptions& o) {
  if (!(o.sweep_seconds >= 0.1 && o.sweep_seconds <= 600)) {
    return fail(ErrorCode::invalid,
                fmt::format("a sweep of {:g} s is not possible: use 0.1 to 600 s", o.sweep_seconds));
  }
  if (o.sweeps < 1 || o.sweeps > 1000) {
    return fail(ErrorCode::invalid, fmt::format("{} sweeps are not possible: use 1 to 1000", o.sweeps));
  }
  if (!(o.gap_variation_mm >= 0 && o.gap_mm - o.gap_variation_mm > 1 && o.gap_mm <= 200)) {
    return fail(
        ErrorCode::invalid,
        fmt::format("a gap of {:g} +- {:g} mm is not possible: it must stay above 1 mm and below 200 mm",
                    o.gap_mm, o.gap_variation_mm));
  }
  if (o.spots < 0 || o.spots > 1000 || (o.scenario == Scenario::spots && o.spots == 0)) {
    return fail(ErrorCode::invalid, fmt::format("{} marked spots are not possible: use 1 to 1000", o.spots));
  }
  if (!(o.tilt_seconds >= 0.1 && o.tilt_seconds <= 600)) {
    return fail(ErrorCode::invalid,
                fmt::format("a tilt of {:g} s is not possible: use 0.1 to 600 s", o.tilt_seconds));
  }
  for (const double strength : {o.tremor_mm, o.tremor_rad, o.wander_mm, o.wander_rad, o.tilt_start_rad,
                                o.tilt_end_rad, o.object_drift_mm, o.object_drift_rad}) {
    if (strength >= 0 && strength <= 20) continue;
    return fail(ErrorCode::invalid,
                fmt::format("a hand movement of {:g} is not possible: use 0 to 20", strength));
  }
  return {};
}

}  // namespace linescope::twin
