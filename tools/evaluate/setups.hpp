// The experiments of the thesis as options of the digital twin. One set of noise for all of them (preset
// "thesis"); only what the thesis says was different differs.
#pragma once

#include <cstdint>

#include "acquire/twin/twin_options.hpp"

namespace linescope::evaluate {

/// System II (4.5, 5.3): camera II in water, b = 6 mm, 14 degrees, flat sheet.
twin::TwinOptions system_ii(std::uint64_t seed);

/// System I (4.4): camera I in air. Its baseline is not printed. With 6 mm the printed camera does not see
/// the line at 10 mm, one of the thesis's gaps, with 5 mm it does.
twin::TwinOptions system_i(std::uint64_t seed);

/// The same with the sheet as the prism bends it.
twin::TwinOptions with_bent_sheet(twin::TwinOptions options);

/// Two sweeps or more, to and fro, at a gap that the operator holds as well as a hand can.
twin::TwinOptions sweeping(twin::TwinOptions options, double gap_mm, double seconds);

/// Sweeps with the gap wandering within 10 .. 20 mm, as on the cylinders and the knee (4.5.2).
twin::TwinOptions sweeping_freely(twin::TwinOptions options, double seconds);

twin::PhantomOptions phantom(const char* name);

}  // namespace linescope::evaluate
