// Pictures of a green laser line on tissue-like ground with known truth: those of the published comparison,
// so that figures can be compared (line sigma 2 px, 90..170 grey levels high, noise of 4 grey levels in every
// channel).
#pragma once

#include <opencv2/core.hpp>

namespace linescope::bench {

inline constexpr int kWidth = 640;
inline constexpr int kHeight = 480;
inline constexpr double kLineSigma = 2.0;
inline constexpr double kNoise = 4.0;

double line_centre(int x, int frame);
double line_height(int x);

/// Seeded by the frame's number: the same bytes every time.
cv::Mat line_picture(int frame);

/// No unbiased estimator on the green channel alone can be better, px rms over all columns.
double cramer_rao_bound();

}  // namespace linescope::bench
