// What one call of a source's next() brought.
#pragma once

#include <cstdint>

namespace linescope {

/// Shared by camera and tracker sources.
enum class Pull : std::uint8_t {
  item,         ///< the output argument holds the next one
  nothing_yet,  ///< a live source waited up to 50 ms in vain; ask again
  end,          ///< a recorded or simulated source is through; it stays at its end
};

}  // namespace linescope
