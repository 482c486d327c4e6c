#include <fmt/format.h>

#include <algorithm>

#include "common/config_schema.hpp"
#include "common/config_value.hpp"

namespace linescope {
namespace {

using Key = ConfigSchema::Key;

bool belongs_to(const Key& key, const std::string& section) {
  return key.name.size() > section.size() && key.name.rfind('.') == section.size() &&
         key.name.compare(0, section.size(), section) == 0;
}

std::string last_part(const std::string& name) {
  return name.substr(name.rfind('.') + 1);
}

std::string unit_suffix(const Key& key) {
  return key.number.unit.empty() ? "" : ' ' + key.number.unit;
}

std::string toml_entry(const Key& key) {
  const std::string origin =
      key.origin == "default" ? "default" : fmt::format("from {}, default {}", key.origin, key.default_text);
  return fmt::format("# {}\n# {}{}; {}\n{} = {}\n", key.description, config::allowed(key), unit_suffix(key),
                     origin, last_part(key.name), config::as_toml(key));
}

/// A bar would end the cell.
std::string cell(const std::string& text) {
  std::string result;
  for (const char c : text) result += c == '|' ? std::string("\\|") : std::string(1, c);
  return result;
}

std::string markdown_row(const Key& key) {
  return fmt::format("| `{}` | {} | {} | `{}` | {} |\n", key.name,
                     key.number.unit.empty() ? "–" : key.number.unit, cell(config::allowed(key)),
                     cell(key.default_text), cell(key.description));
}

}  // namespace

std::string ConfigSchema::to_toml() const {
  std::string text;
  for (const Section& section : sections_) {
    text += fmt::format("{}# {}\n[{}]\n", text.empty() ? "" : "\n", section.description, section.name);
    for (const Key& key : keys_) {
      if (belongs_to(key, section.name)) text += toml_entry(key);
    }
  }
  return text;
}

std::string ConfigSchema::to_markdown() const {
  std::string text;
  for (const Section& section : sections_) {
    text += fmt::format(
        "{}### `[{}]`\n\n{}\n\n| key | unit | allowed | default | meaning |\n| --- | --- | --- | --- | --- "
        "|\n",
        text.empty() ? "" : "\n", section.name, section.description);
    for (const Key& key : keys_) {
      if (belongs_to(key, section.name)) text += markdown_row(key);
    }
  }
  return text;
}

}  // namespace linescope
