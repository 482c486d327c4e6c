#include "tools/calibrate/marker_dictionaries.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <opencv2/aruco.hpp>
#include <string>
#include <utility>

namespace linescope::calibrate {

std::optional<int> marker_dictionary(std::string_view name) {
  using namespace cv::aruco;
  static constexpr std::array<std::pair<std::string_view, int>, 17> kKnown{{
      {"4x4_50", DICT_4X4_50},
      {"4x4_100", DICT_4X4_100},
      {"4x4_250", DICT_4X4_250},
      {"4x4_1000", DICT_4X4_1000},
      {"5x5_50", DICT_5X5_50},
      {"5x5_100", DICT_5X5_100},
      {"5x5_250", DICT_5X5_250},
      {"5x5_1000", DICT_5X5_1000},
      {"6x6_50", DICT_6X6_50},
      {"6x6_100", DICT_6X6_100},
      {"6x6_250", DICT_6X6_250},
      {"6x6_1000", DICT_6X6_1000},
      {"7x7_50", DICT_7X7_50},
      {"7x7_100", DICT_7X7_100},
      {"7x7_250", DICT_7X7_250},
      {"7x7_1000", DICT_7X7_1000},
      {"aruco_original", DICT_ARUCO_ORIGINAL},
  }};
  std::string lower(name);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const auto* const found =
      std::find_if(kKnown.begin(), kKnown.end(), [&](const auto& known) { return known.first == lower; });
  if (found == kKnown.end()) return std::nullopt;
  return found->second;
}

}  // namespace linescope::calibrate
