#include "tools/calibrate/picture_keys.hpp"

namespace linescope::calibrate {

void PictureKeys::declare(ConfigSchema& schema, const std::string& section, int fewest,
                          const std::string& enough) {
  schema.number(section + ".every_ms", every_ms, {.unit = "ms", .min = 0, .max = 60000},
                "Of a recording or a living camera one picture in this time is looked at; 0: all.");
  schema.integer(section + ".most_pictures", most, {.min = static_cast<double>(fewest), .max = 1000}, enough);
}

CollectOptions PictureKeys::wants(const BoardOptions& board) const {
  CollectOptions wanted;
  wanted.board = board;
  wanted.every = static_cast<Nanoseconds>(every_ms * 1e6);
  wanted.most_pictures = static_cast<std::size_t>(most);
  return wanted;
}

void LineKeys::declare(ConfigSchema& schema, const std::string& section) {
  schema.choice(section + ".colour", line.colour, kLaserColourWords,
                "Colour of the laser; mono: the picture has none.");
  schema.choice(section + ".axis", line.axis, kProfileAxisWords,
                "column: the line runs from left to right; row: from top to bottom.");
}

}  // namespace linescope::calibrate
