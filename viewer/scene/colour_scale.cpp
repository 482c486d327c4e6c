#include "viewer/scene/colour_scale.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace linescope {
namespace {

// Five stops are enough for an even rise of lightness from 15 to 90 %.
constexpr double kStops[][3] = {
    {0.05, 0.14, 0.38}, {0.25, 0.30, 0.42}, {0.48, 0.48, 0.47}, {0.72, 0.67, 0.42}, {0.99, 0.90, 0.27}};

double between(double a, double b, double t) {
  return a + (b - a) * t;
}

}  // namespace

const char* name(ColourBy what) {
  switch (what) {
    case ColourBy::plain:
      return "Plain";
    case ColourBy::height:
      return "Height";
    case ColourBy::uncertainty:
      return "Uncertainty";
    case ColourBy::age:
      return "Age";
    case ColourBy::coverage:
      return "Coverage";
  }
  return "?";
}

vtkSmartPointer<vtkLookupTable> colour_scale() {
  constexpr int kColours = 256;
  auto table = vtkSmartPointer<vtkLookupTable>::New();
  table->SetNumberOfTableValues(kColours);
  for (int i = 0; i < kColours; ++i) {
    const double at = 4.0 * i / (kColours - 1);
    const int stop = std::min(static_cast<int>(at), 3);
    const auto &a = kStops[stop], &b = kStops[stop + 1];
    table->SetTableValue(i, between(a[0], b[0], at - stop), between(a[1], b[1], at - stop),
                         between(a[2], b[2], at - stop), 1);
  }
  table->SetNanColor(0.4, 0.4, 0.4, 1);
  table->Build();
  return table;
}

std::pair<double, double> colour_range(std::span<const float> values) {
  std::vector<float> finite;
  finite.reserve(values.size());
  std::copy_if(values.begin(), values.end(), std::back_inserter(finite),
               [](float v) { return std::isfinite(v); });
  if (finite.empty()) return {0, 1};
  const auto at = [&](double fraction) {
    const auto place =
        finite.begin() + static_cast<std::ptrdiff_t>(fraction * static_cast<double>(finite.size() - 1));
    std::nth_element(finite.begin(), place, finite.end());
    return static_cast<double>(*place);
  };
  const double low = at(0.02), high = at(0.98);
  if (high - low > 1e-6) return {low, high};
  return {low - 0.5, high + 0.5};
}

}  // namespace linescope
