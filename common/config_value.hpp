// Between a TOML value and the field of a key. Used by the parts of ConfigSchema only.
#pragma once

#include <toml++/toml.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "common/config_schema.hpp"
#include "common/result.hpp"

namespace linescope::config {

struct WordIndex {
  std::size_t index = 0;
};

/// A checked value, not yet in its field. Numbers are as in the file (not scaled).
using Value = std::variant<double, std::int64_t, bool, std::string, std::vector<double>,
                           std::vector<std::string>, WordIndex>;

/// Type and range checked. The error's message is the end of a sentence that starts with "<file>:<line>: ".
/// @param folder  where relative paths start
Result<Value> convert(const ConfigSchema::Key& key, const toml::node& node,
                      const std::filesystem::path& folder);

/// Puts a value that convert() returned for the same key into its field.
void store(const ConfigSchema::Key& key, const Value& value);

/// The field's present value as TOML ("30", "\"usb\"", "[0, 0, 1]").
std::string as_toml(const ConfigSchema::Key& key);

/// What the key allows, for people: "1 to 240", "at least 0", "\"usb\" or \"serial\"", "true or false",
/// "text".
std::string allowed(const ConfigSchema::Key& key);

/// Text in quotes, escaped as TOML wants it.
std::string quoted(const std::string& text);

/// The same value as convert() would give for the field's present content; for checking defaults.
Result<Value> convert_present(const ConfigSchema::Key& key);

}  // namespace linescope::config
