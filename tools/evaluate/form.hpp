// How large the evaluation is, and how its seeds are gone through.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <thread>
#include <vector>

#include "common/result.hpp"

namespace linescope::evaluate {

struct Form {
  int seeds = 20;             ///< experiments per figure, seeds 1 .. seeds
  double scan_seconds = 3.0;  ///< of every scan of a phantom
  int spots = 30;             ///< of the navigation experiment
  int jobs = 2;               ///< experiments at the same time; the figures do not depend on it
};

/// For the check: everything once through, figures with wide intervals.
inline Form quick_form() {
  return {.seeds = 3, .scan_seconds = 2.0, .spots = 30, .jobs = 2};
}

/// `study` for every seed, in any order, on `form.jobs` threads; results by seed. The first failure by seed.
template <class T>
Result<std::vector<T>> for_each_seed(const Form& form,
                                     const std::function<Result<T>(std::uint64_t seed)>& study) {
  const auto count = static_cast<std::size_t>(form.seeds);
  std::vector<Result<T>> results(count, fail(ErrorCode::internal, "not done"));
  std::atomic<std::size_t> next{0};
  {
    std::vector<std::jthread> workers;
    for (int i = 0; i < form.jobs; ++i) {
      workers.emplace_back([&] {
        for (std::size_t k = next++; k < count; k = next++) results[k] = study(k + 1);
      });
    }
  }
  std::vector<T> values;
  for (Result<T>& result : results) {
    if (!result) return tl::unexpected(result.error());
    values.push_back(std::move(*result));
  }
  return values;
}

}  // namespace linescope::evaluate
