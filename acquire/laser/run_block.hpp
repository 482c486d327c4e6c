// The pixels of up to eight runs of neighbouring profiles, side by side: what sums along a run asks for is
// computed for all of them at once.
#pragma once

#include <array>
#include <cstdint>

#include "acquire/laser/colour_excess.hpp"
#include "acquire/laser/picture_view.hpp"
#include "acquire/laser/run_finder.hpp"

namespace linescope {

inline constexpr int kBlockLanes = 8;
using LaneInts = std::array<std::int32_t, kBlockLanes>;
using LaneFloats = std::array<float, kBlockLanes>;

/// Where the runs lie. Bytes are counted from the picture's first; a pixel is read as the four bytes that
/// begin with its first.
struct RunBlock {
  static constexpr int kLongest = 64;  ///< px; longer runs gain nothing from neighbours and are left out

  std::array<Run, kBlockLanes> run{};
  LaneInts begin_at{};  ///< of the run's first pixel, bytes
  LaneInts length{};    ///< px; 0: no run in this lane
  int longest = 0;      ///< px
  int step = 0;         ///< bytes from one pixel of a profile to the next
  const std::uint8_t* picture = nullptr;
  std::array<int, 3> shift{};  ///< of the channels within the four bytes, in the order of Profile

  /// Starts a picture.
  void begin(const PictureView& picture, ProfileAxis axis, int lead);
  /// Profiles [from, from + count) that have a single run.
  void collect(const RunFinder& runs, int from, int count);

 private:
  int profiles_ = 0;
  std::ptrdiff_t pitch_ = 0;  ///< bytes from one profile to the next
  std::ptrdiff_t end_ = 0;    ///< before this byte four may be read
};

/// The weighted mean of a run: over the colour excess where it reaches the threshold, 0 elsewhere.
struct RunMean {
  float before_end = 0;  ///< px from the pixel behind the run back to the mean
  float sigma = 0;       ///< px, of the Gaussian of the same area and height
  float peak = 1;        ///< of the excess; at least 1
  float saturated = 0;   ///< px
};
struct RunMeanBlock {
  LaneFloats before_end{}, sigma{}, peak{}, saturated{};
  RunMean of(std::size_t lane) const { return {before_end[lane], sigma[lane], peak[lane], saturated[lane]}; }
};
/// Area of a Gaussian over its height and standard deviation.
inline constexpr float kGaussArea = 2.5066F;
struct MeanLevels {
  int threshold = 0, saturation = 255;
};

/// Over the light of the leading channel above `background`; its brightest pixel is the first of several.
struct LightSums {
  int sum = 0;
  int moment = 0;  ///< of the light, about the run's first pixel
  int top = 0;     ///< grey levels, background included
  int excess = 0;  ///< of the brightest pixel
};
struct LightSumsBlock {
  LaneInts sum{}, moment{}, top{}, excess{};
  LightSums of(std::size_t lane) const { return {sum[lane], moment[lane], top[lane], excess[lane]}; }
};

/// One run, in plain C++: the definition.
RunMean run_mean(const Profile& profile, Run run, const ColourExcess& excess, MeanLevels levels);
LightSums light_sums(const Profile& profile, Run run, const ColourExcess& excess, int background);

/// The same for a block by vectors. Precondition: block_sums_known().
bool block_sums_known();
void run_means(const RunBlock& block, const ColourExcess& excess, MeanLevels levels, RunMeanBlock& out);
void light_sums(const RunBlock& block, const ColourExcess& excess, int background, LightSumsBlock& out);

}  // namespace linescope
