#include <fmt/format.h>

#include <cmath>

#include "tools/evaluate/report.hpp"

namespace linescope::evaluate {
namespace {

constexpr const char* kHead = R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>linescope evaluation</title><style>
body { font: 15px/1.45 sans-serif; max-width: 62em; margin: 2em auto; padding: 0 1em; color: #1c2430; }
table { border-collapse: collapse; width: 100%; margin: .6em 0; }
th, td { text-align: right; padding: .25em .6em; border-bottom: 1px solid #d5dbe3; }
th:first-child, td:first-child { text-align: left; }
td.could { color: #12703a; } td.differs { color: #a3331b; }
.caution { background: #fdf1d7; border-left: 4px solid #c98a0b; padding: .5em 1em; }
figure { margin: 1em 0; } figcaption { color: #4b5666; } svg { max-width: 100%; height: auto; }
</style></head><body>
)";

std::string escaped(const std::string& raw) {
  std::string out;
  for (const char c : raw) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else
      out += c;
  }
  return out;
}

std::string cell(const std::optional<Estimate>& e, int digits) {
  if (!e) return "<td>&ndash;</td>";
  if (!std::isfinite(e->half_width)) return fmt::format("<td>{:.{}f}</td>", e->mean, digits);
  return fmt::format("<td>{:.{}f} &plusmn; {:.{}f}</td>", e->mean, digits, e->half_width, digits);
}

std::string thesis_cell(const Row& row) {
  if (!row.thesis) return "<td>&ndash;</td>";
  const Agreement a = agreement(row);
  const char* look = a == Agreement::could_be  ? R"( class="could")"
                     : a == Agreement::differs ? R"( class="differs")"
                                               : "";
  const char* mark = a == Agreement::could_be ? " =" : a == Agreement::differs ? " !" : "";
  return fmt::format("<td{}>{:.{}f}{}</td>", look, *row.thesis, row.digits, mark);
}

std::string as_html(const Table& table) {
  std::string html = fmt::format(
      "<h2 id=\"{}\">{}</h2>\n<table><tr><th></th><th>unit</th><th>thesis</th>"
      "<th>ours, thesis's algorithms</th><th>ours, better algorithms</th></tr>\n",
      table.id, escaped(table.title));
  for (const Row& row : table.rows) {
    html += fmt::format("<tr><td>{}</td><td>{}</td>{}{}{}</tr>\n", escaped(row.what), escaped(row.unit),
                        thesis_cell(row), cell(row.plain, row.digits), cell(row.better, row.digits));
  }
  html += "</table>\n";
  for (const std::string& note : table.notes) html += fmt::format("<p>{}</p>\n", escaped(note));
  return html;
}

}  // namespace

std::string as_html(const Report& report) {
  std::string html = kHead;
  html += fmt::format("<h1>{}</h1>\n<div class=\"caution\">", escaped(report.title));
  for (const std::string& sentence : report.setting) html += fmt::format("<p>{}</p>\n", escaped(sentence));
  html += fmt::format("<p><b>{}</b></p></div>\n<p>{}</p>\n", escaped(kCaution), escaped(kWords));
  for (const Section& section : report.sections) {
    html += as_html(section.table);
    for (const Figure& figure : section.figures) {
      html += fmt::format("<figure id=\"{}\">{}<figcaption>{}</figcaption></figure>\n", figure.id, figure.svg,
                          escaped(figure.caption));
    }
  }
  return html + "</body></html>\n";
}

}  // namespace linescope::evaluate
