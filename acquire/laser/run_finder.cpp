#include "acquire/laser/run_finder.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

#include "common/processor.hpp"

namespace linescope {
namespace {

constexpr int kAmbientRows = 8;  // one row in this many, and one pixel of each group in it

constexpr int kLanes = 8;
using Columns = std::int16_t __attribute__((vector_size(kLanes * sizeof(std::int16_t))));

Columns load(const std::int16_t* p) {
  Columns v;
  std::memcpy(&v, p, sizeof(v));
  return v;
}

void store(std::int16_t* p, Columns v) {
  std::memcpy(p, &v, sizeof(v));
}

/// All ones in the columns whose bit, of the lowest, is set.
Columns chosen(std::uint32_t bits) {
  constexpr Columns kBits{1, 2, 4, 8, 16, 32, 64, 128};
  return (static_cast<std::int16_t>(bits & 0xFF) & kBits) != 0;
}

bool any(Columns v) {
  std::array<std::uint64_t, 2> words{};
  std::memcpy(words.data(), &v, sizeof(v));
  return (words[0] | words[1]) != 0;
}

}  // namespace

RunFinder::RunFinder(bool vectors) : avx512_(vectors && has_avx512()) {}

void RunFinder::sample_ambient(const PictureView& picture, int y, const std::uint32_t* words) {
  const int groups = mask_words(picture.width);
  const std::uint8_t* pixel = picture.data + picture.stride * y;
  std::array<std::uint32_t, 3> sum{};
  std::uint32_t count = 0;
  for (int w = 0; w < groups; ++w, pixel += kMaskGroup * picture.channels) {
    const std::uint32_t free = ~words[w] & 1U;
    for (std::size_t c = 0; c < 3; ++c) sum[c] += free * pixel[picture.channels == 3 ? c : 0];
    count += free;
  }
  for (std::size_t c = 0; c < 3; ++c) ambient_sum_[c] += sum[c];
  ambient_count_ += count;
}

void RunFinder::finish_ambient() {
  for (std::size_t c = 0; c < 3; ++c)
    ambient_[c] =
        ambient_count_ > 0 ? static_cast<float>(ambient_sum_[c]) / static_cast<float>(ambient_count_) : 0;
}

RunFinder::Runs RunFinder::runs(int profile) const {
  const auto p = static_cast<std::size_t>(profile), n = count_.size();
  Runs found;
  found.count = static_cast<std::size_t>(count_[p]);
  for (std::size_t i = 0; i < found.count; ++i) found.run[i] = runs_[i * n + p];
  return found;
}

void RunFinder::find(const PictureView& picture, const MaskRule& rule, int merge_gap, Marker marker,
                     bool want_ambient) {
  const bool columns = rule.axis == ProfileAxis::column;
  const auto profiles = static_cast<std::size_t>(profile_count(picture, rule.axis));
  const int words = mask_words(picture.width);
  gap_ = merge_gap;
  dropped_ = 0;
  ambient_sum_ = {};
  ambient_count_ = 0;
  ambient_ = {};
  words_.resize(static_cast<std::size_t>(words) * static_cast<std::size_t>(picture.height + 1));
  runs_.resize(profiles * kMostRuns);
  count_.assign(profiles, 0);
  if (columns) {
    const std::size_t whole = static_cast<std::size_t>(words) * kMaskGroup;
    open_first_.resize(whole);
    open_last_.assign(whole, kNone);
  }
  const auto take = !columns  ? &RunFinder::take_rows
                    : avx512_ ? &RunFinder::take_columns_avx512
                              : &RunFinder::take_columns;
  std::fill_n(words_.begin(), words, 0U);
  marker(picture, rule, words_.data() + words);
  (this->*take)(words_.data() + words, words, picture.height);
  for (int y = 0; want_ambient && y < picture.height; y += kAmbientRows)
    sample_ambient(picture, y, words_.data() + words * (y + 1));
  if (columns) close_columns(picture.height);
  finish_ambient();
}

/// Only where marks begin and end something happens, not at every marked pixel.
void RunFinder::take_columns(const std::uint32_t* words, int count, int height) {
  constexpr int kBlock = 4;  // words, compared at once
  for (int y = 0; y < height; ++y, words += count)
    for (int block = 0; block < count; block += kBlock) {
      const std::uint32_t* const now = words + block;
      const int n = std::min(kBlock, count - block);
      if (n == kBlock && std::memcmp(now, now - count, kBlock * sizeof(*now)) == 0) continue;
      for (int w = 0; w < n; ++w)
        if (now[w] != now[w - count]) turn(y, (block + w) * kMaskGroup, now[w - count], now[w]);
    }
}

/// Whole vectors of columns: the marks are too ragged for branches on each.
void RunFinder::turn(int y, int x, std::uint32_t before, std::uint32_t now) {
  const auto row = static_cast<std::int16_t>(y), above = static_cast<std::int16_t>(y - 1),
             recent = static_cast<std::int16_t>(y - gap_ - 1);
  const std::uint32_t ends = before & ~now, begins = now & ~before;
  for (int part = 0; part < kMaskGroup; part += kLanes, x += kLanes) {
    if (((ends | begins) >> part & 0xFF) == 0) continue;
    const Columns first = load(open_first_.data() + x), last = load(open_last_.data() + x);
    const Columns ended = chosen(ends >> part);
    store(open_last_.data() + x, (ended & above) | (~ended & last));
    const Columns fresh = chosen(begins >> part) & (last < recent), closing = fresh & (last != kNone);
    store(open_first_.data() + x, (fresh & row) | (~fresh & first));
    for (int i = 0; any(closing) && i < kLanes; ++i)
      if (closing[i] != 0) close(x + i, {first[i], last[i]});
  }
}

void RunFinder::close_columns(int height) {
  const std::size_t words = open_last_.size() / kMaskGroup;
  const std::uint32_t* const last = words_.data() + words * static_cast<std::size_t>(height);
  for (std::size_t w = 0; w < words; ++w)
    for (std::uint32_t open = last[w]; open != 0; open &= open - 1)
      open_last_[w * kMaskGroup + static_cast<std::size_t>(std::countr_zero(open))] =
          static_cast<std::int16_t>(height - 1);
  for (std::size_t x = 0; x < count_.size(); ++x) {
    const Run run{open_first_[x], open_last_[x]};
    if (run.last == kNone) continue;
    if (count_[x] > 0) {
      close(static_cast<int>(x), run);
      continue;
    }
    runs_[x] = run;  // the rule
    count_[x] = 1;
  }
}

void RunFinder::take_rows(const std::uint32_t* words, int count, int height) {
  for (int y = 0; y < height; ++y, words += count) take_row(y, words, count);
}

void RunFinder::take_row(int y, const std::uint32_t* words, int count) {
  Run run{-1, -1};
  for (int w = 0; w < count; ++w) {
    std::uint32_t bits = words[w];
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
  const auto p = static_cast<std::size_t>(profile);
  int& count = count_[p];
  if (count < kMostRuns) {
    run_at(p, count++) = run;
    return;
  }
  ++dropped_;
  int shortest = 0;
  for (int i = 1; i < count; ++i)
    if (run_at(p, i).length() < run_at(p, shortest).length()) shortest = i;
  if (run_at(p, shortest).length() >= run.length()) return;
  for (int i = shortest; i + 1 < count; ++i) run_at(p, i) = run_at(p, i + 1);
  run_at(p, count - 1) = run;
}

}  // namespace linescope
