#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "tools/evaluate/deviations.hpp"
#include "tools/evaluate/sections.hpp"
#include "tools/evaluate/seed_values.hpp"
#include "tools/evaluate/setups.hpp"
#include "tools/evaluate/virtual_session.hpp"

namespace linescope::evaluate {
namespace {

constexpr std::array kPhantoms{"plane", "condyle", "cylinder-50"};

twin::TwinOptions without_noise(const char* name, const Form& form, std::uint64_t seed) {
  twin::TwinOptions options = sweeping_freely(system_ii(seed), 3.0);
  options.duration = nanoseconds_from_seconds(form.scan_seconds);
  static_cast<void>(twin::apply_noise_preset(options, "ideal"));  // a known name cannot fail
  options.phantom = phantom(name);
  return options;
}

Result<double> rms(const VirtualSession& session, const SessionOptions& algorithms, MeshMethod) {
  auto scan = session.acquire(algorithms);
  if (!scan) return tl::unexpected(scan.error());
  return deviations_of(scan->lines, session.truth()).rms;
}

Result<SeedValues> one_seed(const Form& form, std::uint64_t seed) {
  SeedValues values;
  for (const char* name : kPhantoms) {
    auto errors = both_columns(without_noise(name, form, seed), rms);
    if (!errors) return tl::unexpected(errors.error());
    values.push_back({errors->plain, errors->better});
  }
  return values;
}

}  // namespace

Sections noise_free_sections(const Form& form) {
  Form few = form;
  few.seeds = std::min(form.seeds, 5);  // without noise a seed only changes where the hand is
  few.scan_seconds = std::min(form.scan_seconds, 1.0);
  Table table{"noise-free", "What the chain itself loses: no noise, no distortion, no refraction", {}, {}};
  for (const char* name : kPhantoms)
    table.rows.push_back({fmt::format("{}: RMS of all points", name), "mm", {}, {}, {}, 4});
  auto seeds = for_each_seed<SeedValues>(few, [&](std::uint64_t seed) { return one_seed(few, seed); });
  if (!seeds) return tl::unexpected(seeds.error());
  fill_rows(table.rows, *seeds);
  add_note(
      table,
      "Rendered pictures, a tracker without noise, the daemon's own extraction and reconstruction. What is "
      "left is the 8 "
      "bits "
      "of the pictures, the wire's 32-bit floats and poses between samples of a moving hand; the goal is "
      "0.01 mm.");
  return std::vector<Section>{{std::move(table), {}}};
}

}  // namespace linescope::evaluate
