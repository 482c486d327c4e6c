#include "acquire/twin/triangle_file.hpp"

#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <sstream>

namespace linescope::twin {
namespace {

constexpr long kMost = 20'000'000;  // points or triangles; a larger number is no number of a mesh

/// Line by line; comments and empty lines are passed over.
class Lines {
 public:
  explicit Lines(const std::filesystem::path& file) : name_(file.string()), in_(file) {}

  bool open() const { return in_.is_open(); }
  bool next(std::istringstream& line) {
    std::string text;
    while (std::getline(in_, text)) {
      ++number_;
      text = text.substr(0, text.find('#'));
      if (text.find_first_not_of(" \t\r") == std::string::npos) continue;
      line = std::istringstream(text);
      return true;
    }
    return false;
  }
  tl::unexpected<Error> fault(const std::string& what) const {
    return fail(ErrorCode::unreadable, fmt::format("{}:{}: {}", name_, number_, what));
  }

 private:
  std::string name_;
  std::ifstream in_;
  int number_ = 0;
};

struct Counts {
  long points = 0, triangles = 0;
};

Result<Counts> read_head(Lines& lines) {
  std::istringstream line;
  std::string word;
  if (!lines.next(line) || !(line >> word) || word != "OFF")
    return lines.fault("no OFF file: its first word must be OFF");
  Counts counts;
  if (!lines.next(line) || !(line >> counts.points >> counts.triangles) || counts.points < 0 ||
      counts.triangles < 0 || counts.points > kMost || counts.triangles > kMost)
    return lines.fault("the numbers of points and triangles are expected here");
  return counts;
}

Result<void> read_points(Lines& lines, long count, TriangleSoup& mesh) {
  std::istringstream line;
  for (long i = 0; i < count; ++i) {
    Eigen::Vector3d p;
    if (!lines.next(line) || !(line >> p.x() >> p.y() >> p.z()))
      return lines.fault(fmt::format("point {} of {} is missing or no three numbers", i + 1, count));
    mesh.points.push_back(p);
  }
  return {};
}

Result<void> read_faces(Lines& lines, long count, TriangleSoup& mesh) {
  std::istringstream line;
  for (long i = 0; i < count; ++i) {
    int corners = 0;
    std::array<int, 3> t{};
    if (!lines.next(line) || !(line >> corners))
      return lines.fault(fmt::format("triangle {} of {} is missing", i + 1, count));
    if (corners != 3)
      return lines.fault(
          fmt::format("a face with {} corners; only triangles are read (linescope-mesh "
                      "splits polygons)",
                      corners));
    if (!(line >> t[0] >> t[1] >> t[2])) return lines.fault("three point numbers are expected after the 3");
    mesh.triangles.push_back(t);
  }
  return {};
}

}  // namespace

Result<TriangleSoup> read_triangles(const std::filesystem::path& file) {
  Lines lines(file);
  if (!lines.open())
    return fail(ErrorCode::not_found, fmt::format("{}: no such file, or not readable", file.string()));
  auto counts = read_head(lines);
  if (!counts) return tl::unexpected(counts.error());
  TriangleSoup mesh;
  if (auto points = read_points(lines, counts->points, mesh); !points) return tl::unexpected(points.error());
  if (auto faces = read_faces(lines, counts->triangles, mesh); !faces) return tl::unexpected(faces.error());
  return mesh;
}

std::string triangles_text(const TriangleSoup& mesh) {
  std::string text = fmt::format("OFF\n{} {} 0\n", mesh.points.size(), mesh.triangles.size());
  for (const Eigen::Vector3d& p : mesh.points)
    fmt::format_to(std::back_inserter(text), "{} {} {}\n", p.x(), p.y(), p.z());
  for (const auto& t : mesh.triangles)
    fmt::format_to(std::back_inserter(text), "3 {} {} {}\n", t[0], t[1], t[2]);
  return text;
}

}  // namespace linescope::twin
