#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <utility>

#include "common/config_schema.hpp"
#include "common/config_value.hpp"
#include "common/nearest_name.hpp"

namespace linescope {
namespace {

using Key = ConfigSchema::Key;

/// One run over a file: collects faults and checked values, touches no field.
class Reading {
 public:
  Reading(std::vector<Key>& keys, const std::vector<ConfigSchema::Section>& sections, std::string file)
      : keys_(keys),
        sections_(sections),
        file_(std::move(file)),
        folder_(std::filesystem::path(file_).parent_path()) {}

  void walk(const toml::table& table, const std::string& prefix) {
    for (const auto& [key, node] : in_file_order(table)) {
      const std::string name = prefix.empty() ? key : prefix + '.' + key;
      if (is_section(name)) {
        enter(name, *node);
      } else {
        take(name, *node);
      }
    }
  }

  void fault(ErrorCode code, const std::string& key, int line, std::string_view text) {
    const std::string place = line > 0 ? fmt::format("{}:{}", file_, line) : file_;
    faults_.push_back({code, fmt::format("{}: {}", place, text), key, line});
  }

  /// Fills the fields when all is well.
  std::vector<ConfigFault> finish() {
    if (!faults_.empty()) return std::move(faults_);
    for (const auto& [key, value, line] : values_) {
      config::store(*key, value);
      key->origin = line > 0 ? fmt::format("{}:{}", file_, line) : file_;
    }
    return {};
  }

 private:
  struct Checked {
    Key* key;
    config::Value value;
    int line;
  };

  static int line_of(const toml::node& node) { return static_cast<int>(node.source().begin.line); }

  /// toml++ keeps tables sorted by name; people read from top to bottom.
  static std::vector<std::pair<std::string, const toml::node*>> in_file_order(const toml::table& table) {
    std::vector<std::pair<std::string, const toml::node*>> nodes;
    for (const auto& [key, node] : table) nodes.emplace_back(std::string(key.str()), &node);
    std::stable_sort(nodes.begin(), nodes.end(),
                     [](const auto& a, const auto& b) { return line_of(*a.second) < line_of(*b.second); });
    return nodes;
  }

  bool is_section(const std::string& name) const {
    return std::any_of(sections_.begin(), sections_.end(), [&name](const auto& section) {
      return section.name == name || section.name.rfind(name + '.', 0) == 0;
    });
  }

  void enter(const std::string& name, const toml::node& node) {
    if (const toml::table* table = node.as_table()) return walk(*table, name);
    fault(ErrorCode::mismatch, name, line_of(node),
          fmt::format("{0} is a section: write [{0}] and its keys below", name));
  }

  void take(const std::string& name, const toml::node& node) {
    const auto key =
        std::find_if(keys_.begin(), keys_.end(), [&name](const Key& k) { return k.name == name; });
    if (key == keys_.end()) return unknown(name, node);
    auto value = config::convert(*key, node, folder_);
    if (!value) return fault(value.error().code, name, line_of(node), value.error().message);
    values_.push_back({&*key, std::move(*value), line_of(node)});
  }

  void unknown(const std::string& name, const toml::node& node) {
    const bool table = node.is_table();
    std::vector<std::string> known;
    if (table) {
      for (const auto& section : sections_) known.push_back(section.name);
    } else {
      for (const Key& key : keys_) known.push_back(key.name);
    }
    const auto nearest = nearest_name(name, known);
    fault(ErrorCode::usage, name, line_of(node),
          fmt::format("unknown {} {}{}", table ? "section" : "key", name,
                      nearest ? fmt::format("; did you mean {}?", *nearest)
                              : "; --print-config shows all that exist"));
  }

  std::vector<Key>& keys_;
  const std::vector<ConfigSchema::Section>& sections_;
  std::string file_;
  std::filesystem::path folder_;
  std::vector<Checked> values_;
  std::vector<ConfigFault> faults_;
};

}  // namespace

std::vector<ConfigFault> ConfigSchema::read_file(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::ostringstream content;
  if (stream.peek() != std::ifstream::traits_type::eof()) content << stream.rdbuf();
  std::error_code ignored;
  if (stream.is_open() && !stream.bad()) return read_text(content.str(), file.string());
  if (std::filesystem::exists(file, ignored)) {
    return {{ErrorCode::unreadable,
             fmt::format("configuration {} cannot be read; check its permissions and that it is a file",
                         file.string()),
             {},
             0}};
  }
  return {{ErrorCode::not_found,
           fmt::format("there is no configuration file {}; --print-config > {} writes one to start from",
                       file.string(), file.filename().string()),
           {},
           0}};
}

std::vector<ConfigFault> ConfigSchema::read_text(std::string_view toml, const std::string& file_name) {
  if (!mistakes_.empty()) return mistakes_;
  Reading reading(keys_, sections_, file_name);
  try {
    reading.walk(toml::parse(toml, file_name), "");
  } catch (const toml::parse_error& error) {
    reading.fault(ErrorCode::unreadable, {}, static_cast<int>(error.source().begin.line),
                  fmt::format("not valid TOML: {}", error.description()));
  }
  return reading.finish();
}

Result<void> ConfigSchema::set(std::string_view assignment) {
  const auto equals = assignment.find('=');
  if (equals == std::string_view::npos || equals == 0) {
    return fail(ErrorCode::usage,
                fmt::format("\"{}\" is not of the form section.key=value, for example camera.rate_hz=30",
                            assignment));
  }
  const std::string name(assignment.substr(0, equals)), value(assignment.substr(equals + 1));
  const auto key = std::find_if(keys_.begin(), keys_.end(), [&name](const Key& k) { return k.name == name; });
  if (key == keys_.end()) {
    std::vector<std::string> known;
    for (const Key& k : keys_) known.push_back(k.name);
    const auto nearest = nearest_name(name, known);
    return fail(ErrorCode::usage, fmt::format("unknown key {}{}", name,
                                              nearest ? fmt::format("; did you mean {}?", *nearest)
                                                      : "; --print-config shows all that exist"));
  }
  return set_value(*key, value);
}

namespace {

/// The value as TOML; what is not TOML counts as text without its quotes.
toml::table parsed_value(const std::string& value) {
  try {
    return toml::parse("value = " + value);
  } catch (const toml::parse_error&) {
    return toml::table{{"value", value}};
  }
}

}  // namespace

Result<void> ConfigSchema::set_value(Key& key, const std::string& value) {
  const toml::table table = parsed_value(value);
  auto converted = config::convert(key, *table.get("value"), {});
  if (!converted && converted.error().code == ErrorCode::mismatch) {
    const toml::value<std::string> as_text(value);
    if (auto text = config::convert(key, as_text, {})) converted = std::move(text);
  }
  if (!converted)
    return fail(converted.error().code, fmt::format("command line: {}", converted.error().message));
  config::store(key, *converted);
  key.origin = "command line";
  return {};
}

}  // namespace linescope
