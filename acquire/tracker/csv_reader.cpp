#include "acquire/tracker/csv_reader.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace linescope {
namespace {

std::string_view trimmed(std::string_view s) {
  const auto first = s.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return s.substr(first, s.find_last_not_of(" \t\r") - first + 1);
}

void split(std::string_view line, std::vector<std::string_view>& fields) {
  fields.clear();
  for (;;) {
    const auto comma = line.find(',');
    fields.push_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return;
    line.remove_prefix(comma + 1);
  }
}

template <class T>
std::optional<T> parsed(std::string_view s) {
  if (!s.empty() && s.front() == '+') s.remove_prefix(1);
  T value{};
  const auto [end, error] = std::from_chars(s.data(), s.data() + s.size(), value);
  if (error != std::errc() || end != s.data() + s.size()) return std::nullopt;
  return value;
}

bool all_digits(std::string_view s) {
  return s.find_first_not_of("0123456789") == std::string_view::npos;
}

/// Nanoseconds of the digits behind the decimal point; more than nine are cut off.
Nanoseconds nanoseconds_from_fraction(std::string_view digits) {
  Nanoseconds value = 0;
  for (std::size_t i = 0; i < 9; ++i) value = 10 * value + (i < digits.size() ? digits[i] - '0' : 0);
  return value;
}

constexpr double kMostSeconds = 9.2e9;  // what 63 bits of nanoseconds hold

}  // namespace

std::optional<Nanoseconds> nanoseconds_from_decimal_seconds(std::string_view text) {
  const auto value = parsed<double>(text);
  if (!value || !std::isfinite(*value) || std::abs(*value) > kMostSeconds) return std::nullopt;
  const bool negative = text.front() == '-';
  if (negative || text.front() == '+') text.remove_prefix(1);
  const auto point = text.find('.');
  const std::string_view whole = text.substr(0, point);
  const std::string_view fraction =
      point == std::string_view::npos ? std::string_view() : text.substr(point + 1);
  if (!all_digits(whole) || !all_digits(fraction)) return nanoseconds_from_seconds(*value);  // an exponent
  const Nanoseconds result =
      parsed<Nanoseconds>(whole).value_or(0) * kSecond + nanoseconds_from_fraction(fraction);
  return negative ? -result : result;
}

Result<CsvReader> CsvReader::open(const std::filesystem::path& file) {
  CsvReader reader;
  reader.file_ = file;
  std::error_code error;
  if (!std::filesystem::exists(file, error))
    return fail(ErrorCode::not_found, fmt::format("{}: there is no such pose file", file.string()));
  reader.stream_.open(file);
  if (!reader.stream_ || std::filesystem::is_directory(file, error))
    return fail(ErrorCode::unreadable,
                fmt::format("{}: the pose file cannot be opened for reading", file.string()));
  if (!reader.next_line())
    return fail(ErrorCode::invalid,
                fmt::format("{}: the pose file is empty, a header row is expected", file.string()));
  std::vector<std::string_view> names;
  split(reader.text_, names);
  reader.header_.assign(names.begin(), names.end());
  return reader;
}

std::optional<std::size_t> CsvReader::find_column(std::string_view name) const {
  for (std::size_t i = 0; i < header_.size(); ++i)
    if (header_[i] == name) return i;
  return std::nullopt;
}

Result<std::vector<std::size_t>> CsvReader::columns(const std::vector<std::string_view>& names) const {
  std::vector<std::size_t> found;
  std::string missing;
  for (const auto wanted : names) {
    if (const auto column = find_column(wanted))
      found.push_back(*column);
    else
      missing += fmt::format("{}{}", missing.empty() ? "" : ", ", wanted);
  }
  if (missing.empty()) return found;
  return fail(ErrorCode::invalid, fmt::format("{}: column {} is missing, the header must hold {}", where(),
                                              missing, fmt::join(names, ",")));
}

bool CsvReader::next_line() {
  while (std::getline(stream_, text_)) {
    ++line_;
    if (line_ == 1 && text_.starts_with("\xEF\xBB\xBF")) text_.erase(0, 3);
    const auto content = trimmed(text_);
    if (!content.empty() && content.front() != '#') return true;
  }
  return false;
}

bool CsvReader::next_row() {
  if (!next_line()) return false;
  split(text_, fields_);
  return true;
}

Result<std::string_view> CsvReader::text(std::size_t column) const {
  if (column < fields_.size()) return fields_[column];
  return complain(fmt::format("the row has {} fields, {} are expected", fields_.size(), header_.size()));
}

Result<double> CsvReader::number(std::size_t column) const {
  const auto field = text(column);
  if (!field) return tl::unexpected(field.error());
  const auto value = parsed<double>(*field);
  if (value && std::isfinite(*value)) return *value;
  return complain(fmt::format("{} is \"{}\", a finite number is expected", header_[column], *field));
}

Result<long> CsvReader::integer(std::size_t column, long lowest, long highest) const {
  const auto field = text(column);
  if (!field) return tl::unexpected(field.error());
  const auto value = parsed<long>(*field);
  if (value && *value >= lowest && *value <= highest) return *value;
  return complain(fmt::format("{} is \"{}\", a whole number from {} to {} is expected", header_[column],
                              *field, lowest, highest));
}

Result<Nanoseconds> CsvReader::seconds(std::size_t column) const {
  const auto field = text(column);
  if (!field) return tl::unexpected(field.error());
  if (const auto value = nanoseconds_from_decimal_seconds(*field)) return *value;
  return complain(fmt::format("{} is \"{}\", seconds are expected", header_[column], *field));
}

std::string CsvReader::where() const {
  return fmt::format("{}:{}", file_.string(), line_);
}

tl::unexpected<Error> CsvReader::complain(std::string_view what) const {
  return fail(ErrorCode::unreadable, fmt::format("{}: {}", where(), what));
}

}  // namespace linescope
