#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/evaluate/report.hpp"

namespace linescope::evaluate {
namespace {

constexpr std::size_t kLineLength = 110;

std::string wrapped(const std::string& text, const std::string& indent) {
  std::string out = indent;
  std::size_t column = indent.size();
  std::size_t from = 0;
  while (from < text.size()) {
    const std::size_t to = std::min(text.find(' ', from), text.size());
    if (column + (to - from) > kLineLength) {
      out += '\n' + indent;
      column = indent.size();
    }
    out += text.substr(from, to - from) + ' ';
    column += to - from + 1;
    from = to + 1;
  }
  out.back() = '\n';
  return out;
}

std::string printed(const std::optional<double>& value, int digits) {
  return value ? fmt::format("{:.{}f}", *value, digits) : "--";
}

std::string printed(const std::optional<Estimate>& e, int digits) {
  if (!e) return "--";
  if (!std::isfinite(e->half_width)) return fmt::format("{:.{}f}", e->mean, digits);
  return fmt::format("{:.{}f} +- {:.{}f}", e->mean, digits, e->half_width, digits);
}

const char* mark(const Row& row) {
  switch (agreement(row)) {
    case Agreement::could_be:
      return "=";
    case Agreement::differs:
      return "!";
    case Agreement::not_comparable:
      break;
  }
  return " ";
}

std::string as_text(const Table& table) {
  std::string text = fmt::format("{}\n", table.title);
  text += fmt::format("  {:<54}{:>10}   {:>22}{:>22}\n", "", "thesis", "ours, thesis's alg.",
                      "ours, better alg.");
  for (const Row& row : table.rows) {
    const std::string what = row.unit.empty() ? row.what : fmt::format("{} [{}]", row.what, row.unit);
    text += fmt::format("  {:<54}{:>10} {} {:>22}{:>22}\n", what, printed(row.thesis, row.digits), mark(row),
                        printed(row.plain, row.digits), printed(row.better, row.digits));
  }
  for (const std::string& note : table.notes) text += wrapped(note, "    ");
  return text + '\n';
}

}  // namespace

std::string as_text(const Report& report) {
  std::string text = report.title + "\n\n";
  for (const std::string& sentence : report.setting) text += wrapped(sentence, "");
  text += wrapped(kCaution, "") + '\n' + wrapped(kWords, "") + '\n';
  for (const Section& section : report.sections) text += as_text(section.table);
  return text;
}

}  // namespace linescope::evaluate
