#include <fmt/format.h>

#include <array>

#include "tools/evaluate/deviations.hpp"
#include "tools/evaluate/figures.hpp"
#include "tools/evaluate/sections.hpp"
#include "tools/evaluate/seed_values.hpp"
#include "tools/evaluate/setups.hpp"
#include "tools/evaluate/virtual_session.hpp"

namespace linescope::evaluate {
namespace {

struct Site {
  const char* phantom;
  const char* name;
};
constexpr std::array kSites{Site{"condyle", "condyle, 25x10 mm site"},
                            Site{"mini-knee", "mini knee, 9x6x2 mm"}};

/// A scan and its surface against the truth.
struct SiteResult {
  Deviations points, mesh;
  std::size_t count = 0;
  std::vector<MapPoint> map;
};

std::vector<MapPoint> map_of(const VirtualSession& session, const TriangleMesh& mesh) {
  const auto phantom_from_object = session.phantom_from_object();
  std::vector<MapPoint> map;
  for (const Eigen::Vector3f& p : mesh.positions) {
    const Eigen::Vector3d q = phantom_from_object * p.cast<double>();
    map.push_back({q.x(), q.y(), session.truth().distance(p.cast<double>())});
  }
  return map;
}

Result<SiteResult> measured(const VirtualSession& session, const SessionOptions& algorithms,
                            MeshMethod method) {
  auto scan = session.acquire(algorithms);
  if (!scan) return tl::unexpected(scan.error());
  const Surface surface = surface_of(scan->lines, method);
  return SiteResult{deviations_of(scan->lines, session.truth()),
                    deviations_of(surface.mesh.positions, session.truth()), scan->points(),
                    map_of(session, surface.mesh)};
}

using SitePair = Columns<SiteResult>;

Result<SitePair> scanned(const Site& site, const Form& form, std::uint64_t seed) {
  twin::TwinOptions options = sweeping_freely(system_ii(seed), form.scan_seconds);
  options.phantom = phantom(site.phantom);
  return both_columns(options, measured);
}

std::vector<Row> site_rows() {
  std::vector<Row> rows;
  for (const Site& site : kSites) {
    const auto name = [&](const char* what) { return fmt::format("{}: {}", site.name, what); };
    rows.push_back({name("points in the scan"), "", {}, {}, {}, 0});
    rows.push_back({name("bias of the points"), "mm", {}, {}, {}});
    rows.push_back({name("precision of the points"), "mm", {}, {}, {}});
    rows.push_back({name("bias of the surface"), "mm", {}, {}, {}});
    rows.push_back({name("precision of the surface"), "mm", {}, {}, {}});
    rows.push_back({name("RMS of the surface"), "mm", {}, {}, {}});
  }
  return rows;
}

void add_values(const SitePair& pair, SeedValues& values) {
  const auto add = [&](auto value) { values.push_back({value(pair.plain), value(pair.better)}); };
  add([](const SiteResult& r) { return static_cast<double>(r.count); });
  add([](const SiteResult& r) { return r.points.mean; });
  add([](const SiteResult& r) { return r.points.deviation; });
  add([](const SiteResult& r) { return r.mesh.mean; });
  add([](const SiteResult& r) { return r.mesh.deviation; });
  add([](const SiteResult& r) { return r.mesh.rms; });
}

struct SeedOutcome {
  SeedValues values;
  std::vector<MapPoint> map;  ///< of the condyle, first seed only
};

Result<SeedOutcome> one_seed(const Form& form, std::uint64_t seed) {
  SeedOutcome outcome;
  for (const Site& site : kSites) {
    auto pair = scanned(site, form, seed);
    if (!pair) return tl::unexpected(pair.error());
    add_values(*pair, outcome.values);
    if (seed == 1 && outcome.map.empty()) outcome.map = std::move(pair->better.map);
  }
  return outcome;
}

}  // namespace

Sections site_sections(const Form& form) {
  auto seeds = for_each_seed<SeedOutcome>(form, [&](std::uint64_t seed) { return one_seed(form, seed); });
  if (!seeds) return tl::unexpected(seeds.error());
  Table table{"site", "Section 4.5.2: femoral condyle and mini knee against the truth", site_rows(), {}};
  std::vector<SeedValues> values;
  for (const SeedOutcome& s : *seeds) values.push_back(s.values);
  fill_rows(table.rows, values);
  add_note(
      table,
      "The thesis shows these two as pictures, without figures. The surface of the proposed marching cubes "
      "is a "
      "closed double skin around the points; its vertices lie on both sides of the truth, hence its spread.");
  std::vector<Figure> figures{error_map_figure(seeds->front().map)};
  return std::vector<Section>{{std::move(table), std::move(figures)}};
}

}  // namespace linescope::evaluate
