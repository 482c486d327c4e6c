#include "viewer/session/points_file.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>

namespace linescope {
namespace {

constexpr const char* kPointsHead = "line,x_mm,y_mm,z_mm,deviation_mm,intensity";
constexpr const char* kLinesHead = "line,time_ns,seen_from_x_mm,seen_from_y_mm,seen_from_z_mm";

double between(std::pair<double, double> share, double part) {
  return share.first + (share.second - share.first) * part;
}

/// The numbers of a row, or false.
template <std::size_t N>
bool numbers(const std::string& row, std::array<double, N>& values) {
  const char* at = row.data();
  const char* const end = at + row.size();
  for (std::size_t i = 0; i < N; ++i) {
    const auto [stop, error] = std::from_chars(at, end, values[i]);
    if (error != std::errc() || (i + 1 < N && (stop == end || *stop != ','))) return false;
    at = stop + 1;
  }
  return at == end + 1;
}

using Found = std::map<std::uint64_t, std::shared_ptr<HeldLine>>;

tl::unexpected<Error> bad_row(const std::filesystem::path& file, std::size_t row, const char* why) {
  return fail(ErrorCode::unreadable, fmt::format("{}, line {}: {}", file.string(), row, why));
}

Result<std::ifstream> opened(const std::filesystem::path& file, const char* head) {
  std::ifstream in(file);
  if (!in)
    return fail(ErrorCode::not_found, file.string() + " cannot be opened; is this a session's folder?");
  std::string row;
  if (!std::getline(in, row) || row != head)
    return bad_row(file, 1, fmt::format("the heading must be {}", head).c_str());
  return in;
}

Result<HeldLines> read_lines(const std::filesystem::path& file, Found& found) {
  auto in = opened(file, kLinesHead);
  if (!in) return tl::unexpected(in.error());
  HeldLines all;
  std::string row;
  std::array<double, 5> v;
  for (std::size_t n = 2; std::getline(*in, row); ++n) {
    if (!numbers(row, v)) return bad_row(file, n, "five numbers were expected");
    auto line = std::make_shared<HeldLine>();
    line->serial = static_cast<std::uint64_t>(v[0]);
    line->time = static_cast<Nanoseconds>(v[1]);
    line->seen_from = {v[2], v[3], v[4]};
    if (!line->seen_from.allFinite()) return bad_row(file, n, "a coordinate is not a finite number");
    found[line->serial] = line;
    all.push_back(line);
  }
  return all;
}

}  // namespace

Result<void> flushed(std::ofstream& out, const std::filesystem::path& file) {
  if (out.flush()) return {};
  return fail(ErrorCode::full, file.string() + " cannot be written: is the disk full?");
}

tl::unexpected<Error> given_up() {
  return fail(ErrorCode::gone, "Given up, as asked.");
}

Result<void> write_points(const HeldLines& lines, const std::filesystem::path& folder, JobControl& control,
                          std::pair<double, double> share) {
  std::ofstream points(folder / "points.csv"), heads(folder / "lines.csv");
  points << kPointsHead << '\n';
  heads << kLinesHead << '\n';
  fmt::memory_buffer text;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const HeldLine& line = *lines[i];
    // Two daemons' lines may carry the same number: the file counts on its own.
    heads << fmt::format("{},{},{:.4f},{:.4f},{:.4f}\n", i + 1, line.time, line.seen_from.x(),
                         line.seen_from.y(), line.seen_from.z());
    text.clear();
    for (const SurfacePoint& p : line.points)
      fmt::format_to(std::back_inserter(text), "{},{:.4f},{:.4f},{:.4f},{:.4f},{:.1f}\n", i + 1,
                     p.position.x(), p.position.y(), p.position.z(), p.standard_deviation, p.intensity);
    points.write(text.data(), static_cast<std::streamsize>(text.size()));
    if (!control.go_on(between(share, static_cast<double>(i + 1) / static_cast<double>(lines.size()))))
      return given_up();
  }
  if (auto ok = flushed(points, folder / "points.csv"); !ok) return ok;
  return flushed(heads, folder / "lines.csv");
}

Result<HeldLines> read_points(const std::filesystem::path& folder, JobControl& control,
                              std::pair<double, double> share) {
  Found found;
  auto lines = read_lines(folder / "lines.csv", found);
  if (!lines) return lines;
  const auto file = folder / "points.csv";
  auto in = opened(file, kPointsHead);
  if (!in) return tl::unexpected(in.error());
  std::error_code ignored;
  const auto size = static_cast<double>(std::filesystem::file_size(file, ignored));
  double done = 0;
  std::string row;
  std::array<double, 6> v;
  for (std::size_t n = 2; std::getline(*in, row); ++n) {
    if (!numbers(row, v)) return bad_row(file, n, "six numbers were expected");
    const auto line = found.find(static_cast<std::uint64_t>(v[0]));
    if (line == found.end()) return bad_row(file, n, "its line is not in lines.csv");
    const Eigen::Vector3f position = Eigen::Vector3d(v[1], v[2], v[3]).cast<float>();
    if (!position.allFinite()) return bad_row(file, n, "a coordinate is not a finite number");
    line->second->points.push_back({position, static_cast<float>(v[5]), static_cast<float>(v[4])});
    done += static_cast<double>(row.size() + 1);
    if (n % 4096 == 0 && !control.go_on(between(share, done / size))) return given_up();
  }
  return lines;
}

}  // namespace linescope
