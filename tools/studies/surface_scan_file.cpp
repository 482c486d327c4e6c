#include "tools/studies/surface_scan_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <string>

namespace linescope::study {
namespace {

constexpr const char* kFirstLine = "linescope-scan 1";

Error fault(const std::filesystem::path& file, const char* what) {
  return {ErrorCode::unreadable, fmt::format("{}: {}", file.string(), what)};
}

double extent(const std::vector<ScanFileLine>& lines, int axis) {
  std::vector<float> values;
  for (const ScanFileLine& line : lines)
    for (const SurfacePoint& p : line.points) values.push_back(p.position[axis]);
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const std::size_t cut = values.size() / 200;
  return static_cast<double>(values[values.size() - 1 - cut]) - static_cast<double>(values[cut]);
}

bool read_line(std::istream& in, ScanFile& scan) {
  std::size_t count = 0;
  ScanFileLine line;
  in >> line.time >> line.seen_from.x() >> line.seen_from.y() >> line.seen_from.z() >> count;
  for (std::size_t i = 0; i < count && in; ++i) {
    SurfacePoint p{};
    in >> p.position.x() >> p.position.y() >> p.position.z() >> p.standard_deviation;
    line.points.push_back(p);
  }
  scan.lines.push_back(std::move(line));
  return static_cast<bool>(in);
}

}  // namespace

Eigen::Vector2d seen_extent(const std::vector<ScanFileLine>& lines) {
  return {extent(lines, 0), extent(lines, 1)};
}

Result<void> write_scan(const ScanFile& scan, const std::filesystem::path& file) {
  std::ofstream out(file);
  out << kFirstLine << '\n';
  out << fmt::format("axes_mm {} {} {}\n", scan.axes.x(), scan.axes.y(), scan.axes.z());
  out << fmt::format("seen_mm {:.3f} {:.3f}\n", scan.seen.x(), scan.seen.y());
  for (const ScanFileLine& line : scan.lines) {
    const auto& from = line.seen_from;
    out << fmt::format("line {} {:.4f} {:.4f} {:.4f} {}\n", line.time, from.x(), from.y(), from.z(),
                       line.points.size());
    for (const SurfacePoint& p : line.points)
      out << fmt::format("{:.5f} {:.5f} {:.5f} {:.4f}\n", p.position.x(), p.position.y(), p.position.z(),
                         p.standard_deviation);
  }
  out.close();
  if (!out) return tl::unexpected(fault(file, "it cannot be written"));
  return {};
}

Result<ScanFile> read_scan(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string word;
  if (!std::getline(in, word) || word != kFirstLine)
    return tl::unexpected(fault(file, "it is no scan file (surface_scan writes them)"));
  ScanFile scan;
  in >> word >> scan.axes.x() >> scan.axes.y() >> scan.axes.z();
  in >> word >> scan.seen.x() >> scan.seen.y();
  while (in >> word)
    if (word != "line" || !read_line(in, scan)) return tl::unexpected(fault(file, "it ends within a line"));
  if (scan.lines.empty()) return tl::unexpected(fault(file, "there is no line in it"));
  return scan;
}

}  // namespace linescope::study
