#include "common/nearest_name.hpp"

#include <algorithm>

namespace linescope {
namespace {

std::string_view last_part(std::string_view name) {
  return name.substr(name.rfind('.') + 1);
}

std::size_t allowed_distance(std::string_view name) {
  return std::max<std::size_t>(2, name.size() / 3);
}

/// Letters wrong in the whole name; a right key in another section costs one.
std::size_t distance_of_names(std::string_view name, std::string_view known) {
  const std::size_t whole = edit_distance(name, known);
  const bool dotted = last_part(known).size() != known.size();
  return dotted ? std::min(whole, edit_distance(last_part(name), last_part(known)) + 1) : whole;
}

}  // namespace

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), previous(b.size() + 1), current(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) previous[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    current[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = previous[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      current[j] = std::min({replaced, previous[j] + 1, current[j - 1] + 1});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) current[j] = std::min(current[j], before[j - 2] + 1);
    }
    before.swap(previous);
    previous.swap(current);
  }
  return previous[b.size()];
}

std::optional<std::string> nearest_name(std::string_view name, const std::vector<std::string>& known) {
  std::optional<std::string> best;
  std::size_t best_distance = allowed_distance(last_part(name)) + 1;
  for (const std::string& candidate : known) {
    const std::size_t distance = distance_of_names(name, candidate);
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

}  // namespace linescope
