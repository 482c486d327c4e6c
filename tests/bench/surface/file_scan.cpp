#include "tests/bench/surface/file_scan.hpp"

#include <utility>

#include "tools/studies/surface_scan_file.hpp"

namespace linescope::bench {

Result<testing::CondyleScan> scan_from_file(const std::filesystem::path& file) {
  auto read = study::read_scan(file);
  if (!read) return tl::unexpected(read.error());
  testing::CondyleScan scan;
  scan.truth.axes = read->axes;
  scan.plan.stripes = scan.plan.swaths = 1;
  scan.plan.stripe_step = read->seen.x();
  scan.plan.stripe_length = read->seen.y();
  for (auto& line : read->lines) scan.lines.push_back({std::move(line.points), line.seen_from, line.time});
  return scan;
}

}  // namespace linescope::bench
