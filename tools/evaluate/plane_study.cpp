#include "tools/evaluate/plane_study.hpp"

#include <fmt/format.h>

#include <cmath>

#include "tools/evaluate/deviations.hpp"
#include "tools/evaluate/seed_values.hpp"
#include "tools/evaluate/setups.hpp"
#include "tools/evaluate/virtual_session.hpp"

namespace linescope::evaluate {
namespace {

/// One scan at one gap, by one way of finding the line.
struct GapResult {
  Deviations all;
  double between_sweeps = 0;  ///< standard deviation of the two halves' means
};

Result<GapResult> measured(const VirtualSession& session, const SessionOptions& algorithms, double seconds) {
  auto scan = session.acquire(algorithms);
  if (!scan) return tl::unexpected(scan.error());
  const Nanoseconds half = nanoseconds_from_seconds(seconds / 2), end = 2 * half + kSecond;
  const Deviations first = deviations_of(scan->lines, session.truth(), 0, half);
  const Deviations second = deviations_of(scan->lines, session.truth(), half, end);
  return GapResult{deviations_of(scan->lines, session.truth()),
                   std::abs(first.mean - second.mean) / std::sqrt(2.0)};
}

using GapPair = Columns<GapResult>;

std::vector<Row> rows_of(const PlaneStudy& study) {
  std::vector<Row> rows;
  for (const PlaneGap& gap : study.gaps) {
    const auto name = [&](const char* what) { return fmt::format("gap {:g} mm: {}", gap.gap_mm, what); };
    rows.push_back({name("error"), "mm", gap.thesis_error, {}, {}});
    rows.push_back({name("standard deviation"), "mm", gap.thesis_deviation, {}, {}});
    std::optional<double> proportion;
    if (gap.thesis_error) proportion = 100 * *gap.thesis_error / gap.gap_mm;
    rows.push_back({name("error over gap"), "%", proportion, {}, {}});
  }
  rows.push_back({"all gaps: error", "mm", study.thesis_mean_error, {}, {}});
  rows.push_back({"all gaps: standard deviation (precision)", "mm", study.thesis_mean_deviation, {}, {}});
  rows.push_back({"all gaps: bias (signed)", "mm", {}, {}, {}});
  rows.push_back({"all gaps: repeatability, sweep against sweep", "mm", {}, {}, {}});
  return rows;
}

template <class Value>
SeedValue pair_of(const GapPair& gap, Value value) {
  return {value(gap.plain), value(gap.better)};
}

template <class Value>
SeedValue mean_of(const std::vector<GapPair>& gaps, Value value) {
  SeedValue sum{0, 0};
  for (const GapPair& gap : gaps) {
    sum.plain += value(gap.plain) / static_cast<double>(gaps.size());
    sum.better += value(gap.better) / static_cast<double>(gaps.size());
  }
  return sum;
}

double error(const GapResult& r) {
  return std::abs(r.all.mean);
}
double precision(const GapResult& r) {
  return r.all.deviation;
}

SeedValues values_of(const PlaneStudy& study, const std::vector<GapPair>& gaps) {
  SeedValues values;
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    const double gap = study.gaps[i].gap_mm;
    values.push_back(pair_of(gaps[i], error));
    values.push_back(pair_of(gaps[i], precision));
    values.push_back(pair_of(gaps[i], [gap](const GapResult& r) { return 100 * error(r) / gap; }));
  }
  values.push_back(mean_of(gaps, error));
  values.push_back(mean_of(gaps, precision));
  values.push_back(mean_of(gaps, [](const GapResult& r) { return r.all.mean; }));
  values.push_back(mean_of(gaps, [](const GapResult& r) { return r.between_sweeps; }));
  return values;
}

Result<SeedValues> one_seed(const PlaneStudy& study, const Form& form, std::uint64_t seed) {
  std::vector<GapPair> gaps;
  for (const PlaneGap& gap : study.gaps) {
    twin::TwinOptions options = sweeping(study.instrument(seed), gap.gap_mm, form.scan_seconds);
    options.phantom = phantom("plane");
    auto pair =
        both_columns(options, [&](const VirtualSession& session, const SessionOptions& algorithms,
                                  MeshMethod) { return measured(session, algorithms, form.scan_seconds); });
    if (!pair) return tl::unexpected(pair.error());
    gaps.push_back(*pair);
  }
  return values_of(study, gaps);
}

}  // namespace

Result<Table> plane_table(const PlaneStudy& study, const Form& form) {
  Table table{study.id, study.title, rows_of(study), {}};
  auto seeds =
      for_each_seed<SeedValues>(form, [&](std::uint64_t seed) { return one_seed(study, form, seed); });
  if (!seeds) return tl::unexpected(seeds.error());
  fill_rows(table.rows, *seeds);
  const Row& bias = table.rows[table.rows.size() - 2];
  if (bias.plain && bias.better && bias.plain->count > 1) {
    add_note(table,
             fmt::format("Reproducibility of the bias (SD between seeds, each with another distortion of the "
                         "field and another "
                         "hand): {:.2f} mm with the thesis's algorithms, {:.2f} mm with the better ones.",
                         bias.plain->deviation, bias.better->deviation));
  }
  return table;
}

}  // namespace linescope::evaluate
