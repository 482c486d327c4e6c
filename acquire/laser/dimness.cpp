#include "acquire/laser/dimness.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

namespace linescope {
namespace {

/// Peak that one good candidate in twenty exceeds, to a whole grey level; 0 without candidates.
int strong_peak(const CandidateList& candidates) {
  std::array<std::uint32_t, 256> counts{};
  std::uint32_t left = 0;
  for (const Candidate& c : candidates.all) {
    if (!c.good) continue;
    ++counts[static_cast<std::size_t>(std::clamp(c.peak, 0.0F, 255.0F))];
    ++left;
  }
  left /= 20;
  int peak = 255;
  for (; peak > 0 && counts[static_cast<std::size_t>(peak)] <= left; --peak)
    left -= counts[static_cast<std::size_t>(peak)];
  return peak;
}

}  // namespace

void reject_dim(CandidateList& candidates, float noise, const LineExtractorOptions& options) {
  float least = static_cast<float>(options.min_snr) * noise;
  if (options.relative_threshold > 0) {
    least = std::max(
        least, static_cast<float>(options.relative_threshold) * static_cast<float>(strong_peak(candidates)));
  }
  for (Candidate& c : candidates.all)
    if (c.good && c.peak < least) c.reject(NoPoint::too_dim);
}

}  // namespace linescope
