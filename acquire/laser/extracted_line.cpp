#include "acquire/laser/extracted_line.hpp"

namespace linescope {

std::string_view name(NoPoint reason) {
  switch (reason) {
    case NoPoint::no_light:
      return "no light";
    case NoPoint::wrong_colour:
      return "wrong colour";
    case NoPoint::too_dim:
      return "too dim";
    case NoPoint::too_narrow:
      return "too narrow";
    case NoPoint::too_wide:
      return "too wide";
    case NoPoint::saturated:
      return "saturated";
    case NoPoint::at_border:
      return "at the border";
    case NoPoint::isolated:
      return "isolated";
    case NoPoint::ambiguous:
      return "ambiguous";
    case NoPoint::bad_picture:
      return "bad picture";
  }
  return "unknown";
}

}  // namespace linescope
