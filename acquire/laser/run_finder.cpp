#include "acquire/laser/run_finder.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace linescope {
namespace {

constexpr std::int16_t kNone = -1000;  // so long before the picture that any mark begins a run
constexpr int kAmbientRows = 8;        // one row in this many, and one pixel of each group in it

}  // namespace

void RunFinder::sample_ambient(const PictureView& picture, int y) {
  const std::uint8_t* pixel = picture.data + picture.stride * y;
  for (const std::uint32_t marks : words_) {
    if ((marks & 1U) == 0) {
      for (std::size_t c = 0; c < 3; ++c) ambient_sum_[c] += pixel[picture.channels == 3 ? c : 0];
      ++ambient_count_;
    }
    pixel += kMaskGroup * picture.channels;
  }
}

void RunFinder::find(const PictureView& picture, const MaskRule& rule, int merge_gap, RowMarker marker,
                     bool want_ambient) {
  const bool columns = rule.axis == ProfileAxis::column;
  const auto profiles = static_cast<std::size_t>(profile_count(picture, rule.axis));
  const int words = mask_words(picture.width);
  gap_ = merge_gap;
  dropped_ = 0;
  ambient_sum_ = {};
  ambient_count_ = 0;
  words_.resize(static_cast<std::size_t>(words));
  runs_.resize(profiles * kMostRuns);
  count_.assign(profiles, 0);
  if (columns) {
    words_before_.assign(words_.size(), 0);
    open_first_.resize(profiles);
    open_last_.assign(profiles, kNone);
  }
  for (int y = 0; y < picture.height; ++y) {
    marker(picture, rule, y, words_.data());
    columns ? take_columns(y, words) : take_row(y, words);
    if (want_ambient && y % kAmbientRows == 0) sample_ambient(picture, y);
    if (columns) std::swap(words_, words_before_);
  }
  if (columns) close_columns(picture.height);
  for (std::size_t c = 0; c < 3; ++c)
    ambient_[c] =
        ambient_count_ > 0 ? static_cast<float>(ambient_sum_[c]) / static_cast<float>(ambient_count_) : 0;
}

/// Only where marks begin and end something happens, not at every marked pixel.
void RunFinder::take_columns(int y, int words) {
  for (int w = 0; w < words; ++w) {
    const std::uint32_t now = words_[static_cast<std::size_t>(w)],
                        before = words_before_[static_cast<std::size_t>(w)];
    if (now == before) continue;
    const int x = w * kMaskGroup;
    for (std::uint32_t ends = before & ~now; ends != 0; ends &= ends - 1)
      open_last_[static_cast<std::size_t>(x + std::countr_zero(ends))] = static_cast<std::int16_t>(y - 1);
    for (std::uint32_t begins = now & ~before; begins != 0; begins &= begins - 1)
      begin_stretch(x + std::countr_zero(begins), y);
  }
}

void RunFinder::begin_stretch(int x, int y) {
  std::int16_t& first = open_first_[static_cast<std::size_t>(x)];
  const std::int16_t last = open_last_[static_cast<std::size_t>(x)];
  if (y - last <= gap_ + 1) return;
  if (last != kNone) close(x, {first, last});
  first = static_cast<std::int16_t>(y);
}

void RunFinder::close_columns(int height) {
  for (std::size_t w = 0; w < words_before_.size(); ++w)
    for (std::uint32_t open = words_before_[w]; open != 0; open &= open - 1)
      open_last_[w * kMaskGroup + static_cast<std::size_t>(std::countr_zero(open))] =
          static_cast<std::int16_t>(height - 1);
  for (std::size_t x = 0; x < open_last_.size(); ++x)
    if (open_last_[x] != kNone) close(static_cast<int>(x), {open_first_[x], open_last_[x]});
}

void RunFinder::take_row(int y, int words) {
  Run run{-1, -1};
  for (int w = 0; w < words; ++w) {
    std::uint32_t bits = words_[static_cast<std::size_t>(w)];
    while (bits != 0) {
      const int start = std::countr_zero(bits);
      const int length = std::countr_one(bits >> start);
      const int x = w * kMaskGroup + start;
      if (run.first >= 0 && x - run.last > gap_ + 1) {
        close(y, run);
        run.first = -1;
      }
      if (run.first < 0) run.first = static_cast<std::int16_t>(x);
      run.last = static_cast<std::int16_t>(x + length - 1);
      bits = start + length >= kMaskGroup ? 0 : bits & (~std::uint32_t{0} << (start + length));
    }
  }
  if (run.first >= 0) close(y, run);
}

void RunFinder::close(int profile, Run run) {
  int& count = count_[static_cast<std::size_t>(profile)];
  Run* const begin = runs_.data() + static_cast<std::size_t>(profile) * kMostRuns;
  if (count < kMostRuns) {
    begin[count++] = run;
    return;
  }
  ++dropped_;
  Run* const shortest =
      std::min_element(begin, begin + count, [](Run a, Run b) { return a.length() < b.length(); });
  if (shortest->length() >= run.length()) return;
  std::copy(shortest + 1, begin + count, shortest);
  begin[count - 1] = run;
}

}  // namespace linescope
