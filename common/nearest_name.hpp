// "Did you mean ...?"
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace linescope {

/// Number of single-letter insertions, deletions, replacements and swaps of neighbours that lead from `a` to
/// `b` (optimal string alignment distance).
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The known name that `name` most probably means, or nothing when none is near (more than a third of its
/// letters differ). Dotted names are also compared by their last part, so that a key in the wrong section
/// finds the right one. The first of equally near names wins.
std::optional<std::string> nearest_name(std::string_view name, const std::vector<std::string>& known);

}  // namespace linescope
