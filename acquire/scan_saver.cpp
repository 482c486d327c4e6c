#include "acquire/scan_saver.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cstring>
#include <fstream>
#include <vector>

#include "ipc/segment_reader.hpp"

namespace linescope {
namespace {

#pragma pack(push, 1)
struct PlyVertex {
  float x, y, z, intensity, standard_deviation;
  std::uint32_t line;
};
#pragma pack(pop)

Result<std::vector<PlyVertex>> read_scan(const std::string& segment) {
  auto reader = SegmentReader::attach({.name = segment});
  if (!reader) return tl::unexpected(reader.error());
  std::vector<PlyVertex> vertices;
  LineCursor cursor;
  LineBatch batch;
  for (;;) {
    const ReadOutcome outcome = reader->read_lines(cursor, batch);
    if (outcome == ReadOutcome::nothing) return vertices;
    if (outcome != ReadOutcome::ok)
      return fail(ErrorCode::internal, fmt::format("the scan cannot be read back: {}", name(outcome)));
    if (batch.restarted) vertices.clear();
    if (batch.lines.empty()) return vertices;
    for (const Line& line : batch.lines)
      for (std::uint32_t i = 0; i < line.point_count; ++i) {
        const SurfacePoint& p = batch.points[line.first_point + i];
        vertices.push_back(
            {p.position.x(), p.position.y(), p.position.z(), p.intensity, p.standard_deviation, line.index});
      }
  }
}

std::string header(std::size_t count) {
  return fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment linescope scan, not for clinical use\ncomment frame "
      "world (transmitter), unit mm\n"
      "element vertex {}\nproperty float x\nproperty float y\nproperty float z\nproperty float intensity\n"
      "property float standard_deviation\nproperty uint line\nend_header\n",
      count);
}

}  // namespace

Result<std::size_t> save_scan(const std::string& segment, const std::filesystem::path& file) {
  auto vertices = read_scan(segment);
  if (!vertices) return tl::unexpected(vertices.error());
  const std::filesystem::path partial = file.string() + ".part";
  std::ofstream out(partial, std::ios::binary);
  const std::string head = header(vertices->size());
  out.write(head.data(), static_cast<std::streamsize>(head.size()));
  out.write(reinterpret_cast<const char*>(vertices->data()),
            static_cast<std::streamsize>(vertices->size() * sizeof(PlyVertex)));
  out.close();
  std::error_code error;
  if (out) std::filesystem::rename(partial, file, error);
  if (!out || error) {
    std::error_code ignored;
    std::filesystem::remove(partial, ignored);
    return fail(ErrorCode::permission, fmt::format("{} cannot be written: {}", file.string(),
                                                   error ? error.message() : "disk full or no such folder"));
  }
  return vertices->size();
}

Result<void> ScanSaver::begin(const std::filesystem::path& file) {
  if (running_.valid())
    return fail(ErrorCode::busy, "the former scan is still being saved: try again in a moment");
  running_ = std::async(std::launch::async, save_scan, segment_, file);
  return {};
}

std::optional<Result<std::size_t>> ScanSaver::finished() {
  if (!running_.valid() || running_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
    return std::nullopt;
  return running_.get();
}

}  // namespace linescope
