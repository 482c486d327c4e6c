#include "tools/calibrate/record_entry.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>
#include <fstream>
#include <opencv2/core.hpp>

#include "common/version.hpp"

namespace linescope::calibrate {
namespace {

namespace fs = std::filesystem;

void write(cv::FileStorage& out, const char* key, const std::vector<Figure>& figures) {
  out << key << "[";
  for (const Figure& f : figures)
    out << "{"
        << "name" << f.name << "value" << f.value << "deviation" << f.deviation << "unit" << f.unit << "}";
  out << "]";
}

void write(cv::FileStorage& out, const Entry& e) {
  const Quality& q = e.quality;
  out << "{"
      << "step" << e.step << "date" << e.date << "version" << e.version << "source" << e.source
      << "inputs_hash" << e.inputs_hash << "method" << e.method << "previous" << e.previous;
  out << "offered" << static_cast<int>(q.offered) << "used" << static_cast<int>(q.used) << "unit" << q.unit
      << "residual" << q.residual << "held_out" << q.held_out << "held_out_count"
      << static_cast<int>(q.held_out_count);
  write(out, "parameters", q.parameters);
  write(out, "spread", q.spread);
  out << "left_out"
      << "[";
  for (const LeftOut& l : q.left_out)
    out << "{"
        << "name" << l.name << "reason" << l.reason << "}";
  out << "]"
      << "}";
}

/// Without the head of a file of its own.
std::string history_text(const std::vector<Entry>& entries) {
  cv::FileStorage out(".yaml",
                      cv::FileStorage::WRITE | cv::FileStorage::MEMORY | cv::FileStorage::FORMAT_YAML);
  out << "history"
      << "[";
  for (const Entry& e : entries) write(out, e);
  out << "]";
  const std::string text = out.releaseAndGetString();
  return text.substr(text.find("history"));
}

std::vector<Figure> read_figures(const cv::FileNode& node) {
  std::vector<Figure> figures;
  for (const cv::FileNode& f : node)
    figures.push_back({f["name"].string(), f["value"].real(), f["deviation"].real(), f["unit"].string()});
  return figures;
}

std::size_t count_in(const cv::FileNode& node) {
  return static_cast<std::size_t>(std::max(0, static_cast<int>(node)));
}

Entry read(const cv::FileNode& n) {
  Entry e{n["step"].string(),        n["date"].string(),   n["version"].string(),  n["source"].string(),
          n["inputs_hash"].string(), n["method"].string(), n["previous"].string(), {}};
  Quality& q = e.quality;
  q.offered = count_in(n["offered"]);
  q.used = count_in(n["used"]);
  q.unit = n["unit"].string();
  q.residual = n["residual"].real();
  q.held_out = n["held_out"].real();
  q.held_out_count = count_in(n["held_out_count"]);
  q.parameters = read_figures(n["parameters"]);
  q.spread = read_figures(n["spread"]);
  for (const cv::FileNode& l : n["left_out"])
    q.left_out.push_back({l["name"].string(), l["reason"].string()});
  return e;
}

bool there(const fs::path& file) {
  std::error_code ignored;
  return fs::exists(file, ignored);
}

Result<void> replace(const fs::path& file, const std::string& text) {
  const fs::path partial = file.string() + ".part";
  std::ofstream out(partial);
  out << text;
  out.close();
  std::error_code error;
  if (out) fs::rename(partial, file, error);
  if (out && !error) return {};
  std::error_code ignored;
  fs::remove(partial, ignored);
  return fail(ErrorCode::permission, fmt::format("calibration {}: cannot be written there", file.string()));
}

}  // namespace

Entry make_entry(std::string step, std::string source, std::uint64_t inputs_hash, std::string method,
                 Quality quality) {
  const std::string date = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
  return {std::move(step),   date, kVersion,          std::move(source), fmt::format("{:016x}", inputs_hash),
          std::move(method), {},   std::move(quality)};
}

Result<void> store(const fs::path& file, const Calibration& fallback, Entry entry,
                   const std::function<std::string(Calibration&)>& change) {
  auto calibration = there(file) ? load_calibration(file) : Result<Calibration>(fallback);
  if (!calibration) return tl::unexpected(calibration.error());
  auto entries = read_entries(file);
  if (!entries) return tl::unexpected(entries.error());
  entry.previous = change(*calibration);
  entries->push_back(std::move(entry));
  auto text = calibration_text(*calibration);
  if (!text)
    return fail(text.error().code,
                fmt::format("calibration {}: not written: {}", file.string(), text.error().message));
  return replace(file, *text + history_text(*entries));
}

Result<std::vector<Entry>> read_entries(const fs::path& file) {
  std::vector<Entry> entries;
  if (!there(file)) return entries;
  try {
    const cv::FileStorage in(file.string(), cv::FileStorage::READ | cv::FileStorage::FORMAT_YAML);
    if (!in.isOpened())
      return fail(ErrorCode::unreadable, fmt::format("calibration {}: not OpenCV YAML", file.string()));
    for (const cv::FileNode& node : in["history"]) entries.push_back(read(node));
  } catch (const cv::Exception& e) {
    return fail(ErrorCode::unreadable,
                fmt::format("calibration {}: not OpenCV YAML ({})", file.string(), e.err));
  }
  return entries;
}

}  // namespace linescope::calibrate
