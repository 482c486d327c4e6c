// A configuration file (TOML) whose keys are declared once: name, unit, range, default, meaning, and the
// field they fill.
//
//   ConfigSchema schema;
//   schema.section("camera", "Where the pictures come from.");
//   schema.number("camera.rate_hz", options.rate_hz, {.unit = "Hz", .min = 1, .max = 240}, "Pictures per
//   second."); schema.number("laser.alpha_deg", options.alpha, {.unit = "deg", .min = 0, .max = 45, .scale =
//   pi / 180}, "..."); schema.choice("tracker.port", options.port, {{"usb", Port::usb}, {"serial",
//   Port::serial}}, "..."); for (const ConfigFault& fault : schema.read_file("scan.toml")) std::cerr <<
//   fault.message << '\n';
//
// The value a field has when it is declared is the key's default. Fields must outlive the schema. From one
// declaration come the checks, the effective configuration (`--print-config`) and the table of
// docs/configuration.md. Threads: one at a time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "common/result.hpp"

namespace linescope {

/// One thing wrong with a file. `message` is complete: "scan.toml:12: unknown key camera.rate; did you mean
/// camera.rate_hz?".
struct ConfigFault {
  ErrorCode code = ErrorCode::invalid;  ///< not_found, unreadable (not TOML), usage (unknown key), mismatch
                                        ///< (type), invalid (range)
  std::string message;
  std::string key;  ///< as written in the file, empty when the fault is not about a key
  int line = 0;     ///< 1-based, 0 when the fault has no place in the file
};

/// Unit and range of a number, all as written in the file. The field holds `scale` times the file's number.
struct NumberSpec {
  std::string unit = {};  ///< "mm", "Hz"; empty: a plain number
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  double scale = 1;  ///< field = scale * file: pi / 180 for angles, 1e6 for nanoseconds given in ms
};

/// How many items a list may have.
struct ListSpec {
  std::size_t min_items = 0;
  std::size_t max_items = std::numeric_limits<std::size_t>::max();
};

class ConfigSchema {
 public:
  /// A heading with one sentence; sections appear in the order of their declaration. "a.b" is allowed.
  void section(std::string name, std::string description);

  /// Keys: "section.key", the section declared before. Declaring a key twice, a key without section, or a
  /// default that its own range forbids is a mistake of the program: the next read_*() and check() report it
  /// as `internal`.
  void number(std::string key, double& field, NumberSpec spec, std::string description);
  void number(std::string key, float& field, NumberSpec spec, std::string description);
  void integer(std::string key, int& field, NumberSpec spec, std::string description);
  void integer(std::string key, std::int64_t& field, NumberSpec spec, std::string description);
  void flag(std::string key, bool& field, std::string description);
  void text(std::string key, std::string& field, std::string description);
  /// A relative path in a file counts from the folder of that file; empty stays empty.
  void path(std::string key, std::filesystem::path& field, std::string description);
  void numbers(std::string key, std::vector<double>& field, NumberSpec spec, ListSpec list,
               std::string description);
  void texts(std::string key, std::vector<std::string>& field, ListSpec list, std::string description);

  /// One word of several, kept as an enum.
  template <class Enum>
  void choice(std::string key, Enum& field, std::vector<std::pair<std::string, Enum>> words,
              std::string description) {
    Words binding;
    for (const auto& word : words) binding.words.push_back(word.first);
    binding.store = [&field, words](std::size_t i) { field = words[i].second; };
    binding.load = [&field, words] {
      std::size_t i = 0;
      while (i < words.size() && words[i].second != field) ++i;
      return i;
    };
    add(std::move(key), std::move(binding), {}, {}, std::move(description));
  }
  template <class Enum, std::size_t N>
  void choice(std::string key, Enum& field, const std::array<std::pair<const char*, Enum>, N>& words,
              std::string description) {
    choice(std::move(key), field, std::vector<std::pair<std::string, Enum>>(words.begin(), words.end()),
           std::move(description));
  }
  /// One word of several, kept as text.
  void choice(std::string key, std::string& field, std::vector<std::string> words, std::string description);

  /// Reads and checks everything, then fills the fields: all of them, or, when there is any fault, none. All
  /// faults are returned, in the order of the file; only a syntax error hides the faults after it. Keys that
  /// are not in the file keep their value, so that a second file adds to the first.
  std::vector<ConfigFault> read_file(const std::filesystem::path& file);
  std::vector<ConfigFault> read_text(std::string_view toml, const std::string& file_name);

  /// One key from the command line ("camera.rate_hz=30"; the value as in TOML, quotes around text may be left
  /// out).
  Result<void> set(std::string_view assignment);

  /// Mistakes in the declarations themselves; empty in a correct program.
  std::vector<ConfigFault> check() const { return mistakes_; }

  /// Where a key got its value: "scan.toml:12", "command line" or "default". For messages of later checks.
  std::string origin(std::string_view key) const;

  /// The effective configuration as commented TOML; reading it back gives the same fields to the last bit.
  std::string to_toml() const;

  /// One Markdown table per section: key, unit, allowed, default, meaning.
  std::string to_markdown() const;

  // For the implementation: what one key is. Public so that the parts of it can share it.
  struct Words {
    std::vector<std::string> words;
    std::function<void(std::size_t)> store;
    std::function<std::size_t()> load;
  };
  using Field = std::variant<double*, float*, int*, std::int64_t*, bool*, std::string*,
                             std::filesystem::path*, std::vector<double>*, std::vector<std::string>*, Words>;
  struct Key {
    std::string name;
    Field field;
    NumberSpec number;
    ListSpec list;
    std::string description;
    std::string default_text;  ///< as TOML
    std::string origin = "default";
  };
  struct Section {
    std::string name;
    std::string description;
  };
  const std::vector<Key>& keys() const { return keys_; }
  const std::vector<Section>& sections() const { return sections_; }

 private:
  void add(std::string key, Field field, NumberSpec spec, ListSpec list, std::string description);
  void mistake(const std::string& key, const std::string& what);
  Result<void> set_value(Key& key, const std::string& value);

  std::vector<Section> sections_;
  std::vector<Key> keys_;
  std::vector<ConfigFault> mistakes_;
};

}  // namespace linescope
