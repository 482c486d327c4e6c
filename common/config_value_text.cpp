#include "common/config_value_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <cmath>
#include <limits>

#include "common/config_value.hpp"

namespace linescope::config {
namespace {

/// TOML tells whole numbers and others apart only by the point or exponent; both are accepted where a number
/// is due.
std::string plain(double number) {
  if (std::isnan(number)) return "nan";
  return fmt::format("{}", number);
}

/// Not std::stod: that one obeys the locale of the process.
double parsed(const std::string& text) {
  double number = std::numeric_limits<double>::quiet_NaN();
  std::from_chars(text.data(), text.data() + text.size(), number);
  return number;
}

struct TomlWriter {
  const ConfigSchema::Key& key;

  std::string operator()(const double* field) const { return number_text(*field, key.number.scale); }
  std::string operator()(const float* field) const {
    return key.number.scale == 1 ? fmt::format("{}", *field)
                                 : number_text(static_cast<double>(*field), key.number.scale);
  }
  std::string operator()(const int* field) const { return whole(*field); }
  std::string operator()(const std::int64_t* field) const { return whole(*field); }
  std::string operator()(const bool* field) const { return *field ? "true" : "false"; }
  std::string operator()(const std::string* field) const { return quoted(*field); }
  std::string operator()(const std::filesystem::path* field) const { return quoted(field->string()); }
  std::string operator()(const std::vector<double>* field) const {
    std::vector<std::string> items;
    for (const double number : *field) items.push_back(number_text(number, key.number.scale));
    return fmt::format("[{}]", fmt::join(items, ", "));
  }
  std::string operator()(const std::vector<std::string>* field) const {
    std::vector<std::string> items;
    for (const std::string& item : *field) items.push_back(quoted(item));
    return fmt::format("[{}]", fmt::join(items, ", "));
  }
  std::string operator()(const ConfigSchema::Words& words) const {
    const std::size_t i = words.load();
    return quoted(i < words.words.size() ? words.words[i] : "?");
  }

  std::string whole(std::int64_t field) const {
    return fmt::format("{}", field / static_cast<std::int64_t>(std::llround(key.number.scale)));
  }
};

struct AllowedWriter {
  const ConfigSchema::Key& key;

  std::string operator()(const double*) const { return range_text(key.number); }
  std::string operator()(const float*) const { return range_text(key.number); }
  std::string operator()(const int*) const { return "whole, " + range_text(key.number); }
  std::string operator()(const std::int64_t*) const { return "whole, " + range_text(key.number); }
  std::string operator()(const bool*) const { return "true or false"; }
  std::string operator()(const std::string*) const { return "text"; }
  std::string operator()(const std::filesystem::path*) const { return "path"; }
  std::string operator()(const std::vector<double>*) const {
    return fmt::format("list of {}, each {}", count_text(key.list), range_text(key.number));
  }
  std::string operator()(const std::vector<std::string>*) const {
    return fmt::format("list of {}, each text", count_text(key.list));
  }
  std::string operator()(const ConfigSchema::Words& words) const { return words_text(words.words); }
};

std::string escaped(char c) {
  switch (c) {
    case '"':
      return "\\\"";
    case '\\':
      return "\\\\";
    case '\n':
      return "\\n";
    case '\t':
      return "\\t";
    default:
      return static_cast<unsigned char>(c) < 0x20 || c == 0x7F
                 ? fmt::format("\\u{:04X}", static_cast<unsigned>(static_cast<unsigned char>(c)))
                 : std::string(1, c);
  }
}

}  // namespace

std::string range_text(const NumberSpec& spec) {
  const bool low = std::isfinite(spec.min), high = std::isfinite(spec.max);
  if (low && high) return fmt::format("between {} and {}", spec.min, spec.max);
  if (low) return fmt::format("at least {}", spec.min);
  if (high) return fmt::format("at most {}", spec.max);
  return "any number";
}

std::string count_text(const ListSpec& spec) {
  const bool open = spec.max_items == ListSpec{}.max_items;
  if (open)
    return spec.min_items == 0 ? "any number of items" : fmt::format("at least {} items", spec.min_items);
  if (spec.min_items == spec.max_items) return fmt::format("{} items", spec.min_items);
  return fmt::format("{} to {} items", spec.min_items, spec.max_items);
}

std::string words_text(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? " or " : ", ";
    text += quoted(words[i]);
  }
  return text;
}

std::string number_text(double field, double scale) {
  const double exact = field / scale;
  const std::string rounded = fmt::format("{:.15g}", exact);
  if (parsed(rounded) * scale == field) return rounded;
  for (const double near : {exact, std::nextafter(exact, -HUGE_VAL), std::nextafter(exact, HUGE_VAL)}) {
    if (near * scale == field) return plain(near);
  }
  return plain(exact);
}

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) result += escaped(c);
  return result + '"';
}

std::string as_toml(const ConfigSchema::Key& key) {
  return std::visit(TomlWriter{key}, key.field);
}

std::string allowed(const ConfigSchema::Key& key) {
  return std::visit(AllowedWriter{key}, key.field);
}

}  // namespace linescope::config
