// Real recordings for the tests: all pictures of a folder, and the middles found in one picture row by row.
#pragma once

#include <algorithm>
#include <filesystem>
#include <limits>
#include <opencv2/imgcodecs.hpp>
#include <vector>

#include "acquire/laser/line_extractor.hpp"
#include "tests/support/shared_data.hpp"

namespace linescope::testing {

/// Every file of that folder in the order of its name.
inline std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(shared_data(folder)))
    if (entry.is_regular_file()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

inline LineExtractorOptions along_rows(LaserColour colour) {
  LineExtractorOptions options;
  options.colour = colour;
  options.axis = ProfileAxis::row;
  return options;
}

/// The line's u in every row, NaN where there is none.
inline std::vector<double> middles(LineExtractor& extractor, const std::filesystem::path& file) {
  const cv::Mat picture = cv::imread(file.string());
  std::vector<double> u(static_cast<std::size_t>(picture.rows), std::numeric_limits<double>::quiet_NaN());
  for (const LineSample& s : extractor.extract(picture).samples)
    u[static_cast<std::size_t>(s.v)] = static_cast<double>(s.u);
  return u;
}

/// The upper one of the two in the middle; NaN for nothing.
inline double median(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto half = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), half, values.end());
  return *half;
}

}  // namespace linescope::testing
