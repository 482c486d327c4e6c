#include "common/config_schema.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "common/config_value.hpp"
#include "common/config_value_text.hpp"

namespace linescope {

void ConfigSchema::section(std::string name, std::string description) {
  sections_.push_back({std::move(name), std::move(description)});
}

void ConfigSchema::number(std::string key, double& field, NumberSpec spec, std::string description) {
  add(std::move(key), &field, std::move(spec), {}, std::move(description));
}

void ConfigSchema::number(std::string key, float& field, NumberSpec spec, std::string description) {
  add(std::move(key), &field, std::move(spec), {}, std::move(description));
}

void ConfigSchema::integer(std::string key, int& field, NumberSpec spec, std::string description) {
  add(std::move(key), &field, std::move(spec), {}, std::move(description));
}

void ConfigSchema::integer(std::string key, std::int64_t& field, NumberSpec spec, std::string description) {
  add(std::move(key), &field, std::move(spec), {}, std::move(description));
}

void ConfigSchema::flag(std::string key, bool& field, std::string description) {
  add(std::move(key), &field, {}, {}, std::move(description));
}

void ConfigSchema::text(std::string key, std::string& field, std::string description) {
  add(std::move(key), &field, {}, {}, std::move(description));
}

void ConfigSchema::path(std::string key, std::filesystem::path& field, std::string description) {
  add(std::move(key), &field, {}, {}, std::move(description));
}

void ConfigSchema::numbers(std::string key, std::vector<double>& field, NumberSpec spec, ListSpec list,
                           std::string description) {
  add(std::move(key), &field, std::move(spec), list, std::move(description));
}

void ConfigSchema::texts(std::string key, std::vector<std::string>& field, ListSpec list,
                         std::string description) {
  add(std::move(key), &field, {}, list, std::move(description));
}

void ConfigSchema::choice(std::string key, std::string& field, std::vector<std::string> words,
                          std::string description) {
  Words binding;
  binding.words = words;
  binding.store = [&field, words](std::size_t i) { field = words[i]; };
  binding.load = [&field, words] {
    return static_cast<std::size_t>(std::find(words.begin(), words.end(), field) - words.begin());
  };
  add(std::move(key), std::move(binding), {}, {}, std::move(description));
}

void ConfigSchema::mistake(const std::string& key, const std::string& what) {
  mistakes_.push_back({ErrorCode::internal, fmt::format("declaration of {}: {}", key, what), key, 0});
}

void ConfigSchema::add(std::string key, Field field, NumberSpec spec, ListSpec list,
                       std::string description) {
  const auto dot = key.rfind('.');
  const std::string parent = dot == std::string::npos ? "" : key.substr(0, dot);
  const auto is_parent = [&parent](const Section& s) { return s.name == parent; };
  const auto is_same = [&key](const Key& k) { return k.name == key; };
  if (std::none_of(sections_.begin(), sections_.end(), is_parent))
    mistake(key, "its section is not declared");
  if (std::any_of(keys_.begin(), keys_.end(), is_same)) mistake(key, "it is declared twice");

  keys_.push_back({std::move(key), std::move(field), std::move(spec), list, std::move(description), {}});
  Key& added = keys_.back();
  added.default_text = config::as_toml(added);
  if (const auto fits = config::convert_present(added); !fits) {
    mistake(added.name, fmt::format("its default is not allowed: {}", fits.error().message));
  }
}

std::string ConfigSchema::origin(std::string_view key) const {
  const auto found = std::find_if(keys_.begin(), keys_.end(), [key](const Key& k) { return k.name == key; });
  return found == keys_.end() ? "no such key" : found->origin;
}

}  // namespace linescope
