// Reads a comma-separated file with a header row; every complaint names file and line.
#pragma once

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/result.hpp"
#include "common/time.hpp"

namespace linescope {

/// Blank lines and lines that begin with '#' are skipped; blanks around a field, a carriage return at the
/// line's end and a byte order mark are ignored. No quoting: none of our columns holds a comma.
class CsvReader {
 public:
  /// Fails when there is no such file, it cannot be read, or it has no header.
  static Result<CsvReader> open(const std::filesystem::path& file);

  bool has_column(std::string_view name) const { return find_column(name).has_value(); }
  std::optional<std::size_t> find_column(std::string_view name) const;
  /// Positions of these columns; the failure names all that are missing.
  Result<std::vector<std::size_t>> columns(const std::vector<std::string_view>& names) const;

  /// Steps to the next row; false at the end of the file. A row with fewer fields than the header fails when
  /// they are asked for.
  bool next_row();

  /// Field of the current row.
  Result<std::string_view> text(std::size_t column) const;
  /// A finite number.
  Result<double> number(std::size_t column) const;
  Result<long> integer(std::size_t column, long lowest, long highest) const;
  /// Seconds as nanoseconds, exact for plain decimals: a Unix time with ten digits keeps its nanoseconds.
  Result<Nanoseconds> seconds(std::size_t column) const;

  std::size_t line() const { return line_; }
  /// "poses.csv:17"
  std::string where() const;
  /// `where() + ": " + what`, as a failure that concerns this row.
  tl::unexpected<Error> complain(std::string_view what) const;

 private:
  bool next_line();

  std::filesystem::path file_;
  std::ifstream stream_;
  std::string text_;
  std::size_t line_ = 0;
  std::vector<std::string> header_;
  std::vector<std::string_view> fields_;
};

/// "1686230466.0697396" -> 1686230466069739600. Nothing when it is not a finite number or beyond +-292 years.
std::optional<Nanoseconds> nanoseconds_from_decimal_seconds(std::string_view text);

}  // namespace linescope
