#include "acquire/laser/hump.hpp"

#include <algorithm>
#include <cstdint>

namespace linescope {
namespace {

/// Last index in direction `step` that is above the level, not counting what lies beyond a hole wider than
/// merge_gap.
int reach(const LightWindow& w, int peak, int level, int step, int merge_gap) {
  int last = peak;
  const int end = step < 0 ? -1 : w.size();
  for (int i = peak, hole = 0; i != end && hole <= merge_gap; i += step) {
    const bool above = w.light(i) >= level;
    hole = above ? 0 : hole + 1;
    last = above ? i : last;
  }
  return last;
}

/// How far the level lies beyond pixel `inside`, by a straight line to its neighbour.
float beyond(const LightWindow& w, int level, int inside, int outside) {
  if (outside < 0 || outside >= w.size()) return 0.5F;
  const int drop = w.light(inside) - w.light(outside);
  return drop > 0 ? static_cast<float>(w.light(inside) - level) / static_cast<float>(drop) : 0.5F;
}

float mean_above(const LightWindow& w, const Hump& h) {
  std::int64_t sum = 0, moment = 0;
  for (int i = h.first; i <= h.last; ++i) {
    const int light = std::max(0, w.light(i) - h.level);
    sum += light;
    moment += std::int64_t{light} * (i - h.peak);
  }
  if (sum == 0) return static_cast<float>(h.peak);
  return static_cast<float>(h.peak) + static_cast<float>(moment) / static_cast<float>(sum);
}

}  // namespace

int brightest(const LightWindow& w, int from, int to, int box) {
  box = std::min(box, to - from);
  int sum = 0;
  for (int i = from; i < from + box; ++i) sum += w.light(i);
  int best = sum, at = from;
  for (int i = from + box; i < to; ++i) {
    sum += w.light(i) - w.light(i - box);
    at = sum > best ? i - box + 1 : at;
    best = std::max(best, sum);
  }
  return at + box / 2;
}

Hump hump_around(const LightWindow& w, int peak, int merge_gap) {
  Hump h;
  h.peak = peak;
  const int top =
      (w.light(std::max(peak - 1, 0)) + 2 * w.light(peak) + w.light(std::min(peak + 1, w.size() - 1))) / 4;
  h.height = top - w.background();
  h.level = w.background() + (h.height + 1) / 2;
  h.first = reach(w, peak, h.level, -1, merge_gap);
  h.last = reach(w, peak, h.level, 1, merge_gap);
  h.centre = mean_above(w, h);
  h.width = static_cast<float>(h.last - h.first) + beyond(w, h.level, h.first, h.first - 1) +
            beyond(w, h.level, h.last, h.last + 1);
  return h;
}

}  // namespace linescope
