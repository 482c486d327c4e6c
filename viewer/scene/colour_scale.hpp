// From a figure to a colour: dark blue to yellow, rising in brightness, so that it reads without colour
// vision too.
#pragma once

#include <vtkLookupTable.h>
#include <vtkSmartPointer.h>

#include <cstdint>
#include <span>
#include <utility>

namespace linescope {

enum class ColourBy : std::uint8_t {
  plain,
  height,       ///< towards the endoscope, mm
  uncertainty,  ///< standard deviation, mm
  age,          ///< of the line a point was measured in, s (points only)
  coverage,     ///< measured points that carry a vertex (surface only)
};
const char* name(ColourBy what);

vtkSmartPointer<vtkLookupTable> colour_scale();

/// 2nd to 98th percentile of the finite values, so that a few wild ones do not flatten the picture; widened
/// when there is no spread.
std::pair<double, double> colour_range(std::span<const float> values);

}  // namespace linescope
