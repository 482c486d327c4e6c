// What the evaluation says, before it is written as text, JSON or HTML.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/evaluate/statistics.hpp"

namespace linescope::evaluate {

/// One figure: what the thesis prints, what the thesis's algorithms give on our instrument, what the better
/// ones give.
struct Row {
  std::string what;
  std::string unit;
  std::optional<double> thesis;
  std::optional<Estimate> plain;   ///< ours, with the thesis's algorithms
  std::optional<Estimate> better;  ///< ours, with the better ones
  int digits = 2;                  ///< after the point
};

/// Of a row that has both: the thesis's figure could have come out of one of our experiments.
enum class Agreement { not_comparable, could_be, differs };
Agreement agreement(const Row& row);

struct Table {
  std::string id;  ///< short, for --only and JSON: "plane"
  std::string title;
  std::vector<Row> rows;
  std::vector<std::string> notes;  ///< full sentences
};

/// One more sentence below the table.
void add_note(Table& table, std::string_view sentence);

struct Figure {
  std::string id;
  std::string caption;
  std::string svg;  ///< a whole <svg> element
};

/// A table with the figures that belong to it.
struct Section {
  Table table;
  std::vector<Figure> figures;
};

struct Report {
  std::string title;
  std::vector<std::string> setting;  ///< what it was made with: full sentences
  std::vector<Section> sections;
};

/// In every report, whatever its form.
inline constexpr const char* kCaution =
    "Research software. Not for clinical use. No figure of this report says anything about patients.";
inline constexpr const char* kSimulated =
    "SIMULATED: pictures and tracker samples come from the digital twin, not from an instrument.";
inline constexpr const char* kRecorded = "Measured on a recorded session; the truth is not known.";

/// The words of ASTM F2554 as the rows use them.
extern const char* const kWords;

std::string as_text(const Report& report);
std::string as_json(const Report& report);
std::string as_html(const Report& report);

}  // namespace linescope::evaluate
