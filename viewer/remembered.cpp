#include "viewer/remembered.hpp"

#include <QSettings>

namespace linescope {
namespace {

QSettings settings() {
  return {QSettings::IniFormat, QSettings::UserScope, "linescope", "viewer"};
}

/// Visits every value once, for reading and for writing.
template <class Visit>
void each(Remembered& r, const Visit& visit) {
  visit("window/width", r.options.width, 960, 16384);
  visit("window/height", r.options.height, 600, 16384);
  visit("window/font_scale", r.options.font_scale, 0.5, 4.0);
  visit("surface/method", r.options.mesher.method, 0, 2);
  visit("surface/interval_mm", r.options.mesher.interval, 0.2, 10.0);
  visit("navigate/normal", r.options.normal, 0, 1);
  visit("navigate/angle_tolerance_deg", r.window.tolerance.angle_deg, 0.5, 20.0);
  visit("navigate/distance_tolerance_mm", r.window.tolerance.distance_mm, 0.5, 20.0);
  visit("navigate/sound", r.window.sound, 0, 1);
  visit("views/layout", r.window.layout, 0, 2);
  visit("views/flipped", r.window.flipped, 0, 1);
  visit("surface/colour", r.window.colour, 0, 4);
  visit("surface/smooth", r.window.smooth, 0, 1);
  visit("evaluation/shape", r.window.evaluation.shape, 0, 2);
  visit("evaluation/nominal_mm", r.window.evaluation.nominal, 0.0, 500.0);
  visit("evaluation/radius_mm", r.window.evaluation.region.radius, 0.5, 100.0);
}

}  // namespace

Remembered recall() {
  Remembered r;
  QSettings from = settings();
  each(r, [&](const char* key, auto& value, double low, double high) {
    bool good = false;
    const double found = from.value(key).toDouble(&good);
    if (good && found >= low && found <= high)
      value = static_cast<std::remove_reference_t<decltype(value)>>(found);
  });
  return r;
}

void remember(const Remembered& present) {
  Remembered r = present;
  QSettings into = settings();
  each(r,
       [&](const char* key, auto& value, double, double) { into.setValue(key, static_cast<double>(value)); });
}

}  // namespace linescope
