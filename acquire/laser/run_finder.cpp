#include "acquire/laser/run_finder.hpp"

#include <algorithm>
#include <bit>

namespace linescope {
namespace {

constexpr int kAmbientRows = 8;  // one row in this many, and one pixel of each group in it

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

void RunFinder::find(const PictureView& picture, const MaskRule& rule, int merge_gap, RowMarker marker) {
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
  if (columns) open_.assign(profiles, Run{-1, -1});
  for (int y = 0; y < picture.height; ++y) {
    marker(picture, rule, y, words_.data());
    columns ? take_columns(y, words) : take_row(y, words);
    if (y % kAmbientRows == 0) sample_ambient(picture, y);
  }
  for (std::size_t c = 0; c < 3; ++c) {
    ambient_[c] =
        ambient_count_ > 0 ? static_cast<float>(ambient_sum_[c]) / static_cast<float>(ambient_count_) : 0;
  }
  if (!columns) return;
  for (std::size_t x = 0; x < profiles; ++x)
    if (open_[x].first >= 0) close(static_cast<int>(x), open_[x]);
}

void RunFinder::take_columns(int y, int words) {
  for (int w = 0; w < words; ++w) {
    for (std::uint32_t bits = words_[static_cast<std::size_t>(w)]; bits != 0; bits &= bits - 1) {
      const int x = w * kMaskGroup + std::countr_zero(bits);
      Run& run = open_[static_cast<std::size_t>(x)];
      if (run.first >= 0 && y - run.last > gap_ + 1) {
        close(x, run);
        run.first = -1;
      }
      if (run.first < 0) run.first = y;
      run.last = y;
    }
  }
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
      if (run.first < 0) run.first = x;
      run.last = x + length - 1;
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
