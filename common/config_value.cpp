#include "common/config_value.hpp"

#include <fmt/format.h>

#include <cmath>

#include "common/config_value_text.hpp"
#include "common/nearest_name.hpp"

namespace linescope::config {
namespace {

using Key = ConfigSchema::Key;

std::string kind_of(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::string:
      return "text";
    case toml::node_type::integer:
      return "a whole number";
    case toml::node_type::floating_point:
      return "a number with a point";
    case toml::node_type::boolean:
      return "true or false";
    case toml::node_type::array:
      return "a list";
    case toml::node_type::table:
      return "a section";
    default:
      return "a date or time";
  }
}

tl::unexpected<Error> wrong_type(const Key& key, const toml::node& node, std::string_view wanted) {
  return fail(ErrorCode::mismatch, fmt::format("{} must be {}, but is {}", key.name, wanted, kind_of(node)));
}

Result<double> in_range(const Key& key, double number) {
  if (number >= key.number.min && number <= key.number.max) return number;
  return fail(ErrorCode::invalid,
              fmt::format("{} is {}, but must be {}{}{}", key.name, number, range_text(key.number),
                          key.number.unit.empty() ? "" : " ", key.number.unit));
}

Result<double> finite_number(const Key& key, const toml::node& node, std::string_view wanted) {
  const auto number = node.value<double>();
  if (!node.is_number() || !number) return wrong_type(key, node, wanted);
  if (!std::isfinite(*number)) {
    return fail(ErrorCode::invalid, fmt::format("{} is {}, but must be finite", key.name, *number));
  }
  return in_range(key, *number);
}

template <class Field>
Result<Value> whole_number(const Key& key, const toml::node& node) {
  if (!node.is_integer()) return wrong_type(key, node, "a whole number");
  const std::int64_t number = *node.value<std::int64_t>();
  if (const auto fits = in_range(key, static_cast<double>(number)); !fits)
    return tl::unexpected(fits.error());
  Field scaled = 0;
  if (__builtin_mul_overflow(number, std::llround(key.number.scale), &scaled)) {
    return fail(ErrorCode::invalid, fmt::format("{} is {}, which is too large to be kept", key.name, number));
  }
  return Value(number);
}

Result<Value> text(const Key& key, const toml::node& node) {
  if (!node.is_string()) return wrong_type(key, node, "text in quotes");
  return Value(*node.value<std::string>());
}

Result<Value> path(const Key& key, const toml::node& node, const std::filesystem::path& folder) {
  return text(key, node).map([&folder](const Value& value) {
    const std::filesystem::path written = std::get<std::string>(value);
    return Value(written.empty() ? std::string() : (folder / written).lexically_normal().string());
  });
}

Result<Value> word(const Key& key, const std::vector<std::string>& words, const toml::node& node) {
  if (!node.is_string()) return wrong_type(key, node, fmt::format("one of {}", words_text(words)));
  const std::string written = *node.value<std::string>();
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] == written) return Value(WordIndex{i});
  }
  const auto nearest = nearest_name(written, words);
  return fail(ErrorCode::invalid,
              fmt::format("{} is {}, but must be {}{}", key.name, quoted(written), words_text(words),
                          nearest ? fmt::format("; did you mean {}?", quoted(*nearest)) : ""));
}

Result<const toml::array*> list(const Key& key, const toml::node& node, std::string_view wanted) {
  const toml::array* array = node.as_array();
  if (array == nullptr) return wrong_type(key, node, wanted);
  if (array->size() >= key.list.min_items && array->size() <= key.list.max_items) return array;
  return fail(ErrorCode::invalid, fmt::format("{} has {} items, but must have {}", key.name, array->size(),
                                              count_text(key.list)));
}

Result<Value> number_list(const Key& key, const toml::node& node) {
  const auto array = list(key, node, "a list of numbers");
  if (!array) return tl::unexpected(array.error());
  std::vector<double> numbers;
  for (const toml::node& item : **array) {
    const auto number = finite_number(key, item, "a list of numbers");
    if (!number) return tl::unexpected(number.error());
    numbers.push_back(*number);
  }
  return Value(std::move(numbers));
}

Result<Value> text_list(const Key& key, const toml::node& node) {
  const auto array = list(key, node, "a list of texts");
  if (!array) return tl::unexpected(array.error());
  std::vector<std::string> texts;
  for (const toml::node& item : **array) {
    if (!item.is_string()) return wrong_type(key, item, "a list of texts");
    texts.push_back(*item.value<std::string>());
  }
  return Value(std::move(texts));
}

/// One overload per type of field, for std::visit.
struct Converter {
  const Key& key;
  const toml::node& node;
  const std::filesystem::path& folder;

  Result<Value> operator()(double*) const {
    return finite_number(key, node, "a number").map([](double d) { return Value(d); });
  }
  Result<Value> operator()(float*) const { return (*this)(static_cast<double*>(nullptr)); }
  Result<Value> operator()(int*) const { return whole_number<int>(key, node); }
  Result<Value> operator()(std::int64_t*) const { return whole_number<std::int64_t>(key, node); }
  Result<Value> operator()(bool*) const {
    if (!node.is_boolean()) return wrong_type(key, node, "true or false");
    return Value(*node.value<bool>());
  }
  Result<Value> operator()(std::string*) const { return text(key, node); }
  Result<Value> operator()(std::filesystem::path*) const { return path(key, node, folder); }
  Result<Value> operator()(std::vector<double>*) const { return number_list(key, node); }
  Result<Value> operator()(std::vector<std::string>*) const { return text_list(key, node); }
  Result<Value> operator()(const ConfigSchema::Words& words) const { return word(key, words.words, node); }
};

struct Storer {
  const Key& key;
  const Value& value;

  void operator()(double* field) const { *field = std::get<double>(value) * key.number.scale; }
  void operator()(float* field) const {
    *field = static_cast<float>(std::get<double>(value) * key.number.scale);
  }
  void operator()(int* field) const { *field = static_cast<int>(scaled_whole()); }
  void operator()(std::int64_t* field) const { *field = scaled_whole(); }
  void operator()(bool* field) const { *field = std::get<bool>(value); }
  void operator()(std::string* field) const { *field = std::get<std::string>(value); }
  void operator()(std::filesystem::path* field) const { *field = std::get<std::string>(value); }
  void operator()(std::vector<double>* field) const {
    *field = std::get<std::vector<double>>(value);
    for (double& number : *field) number *= key.number.scale;
  }
  void operator()(std::vector<std::string>* field) const {
    *field = std::get<std::vector<std::string>>(value);
  }
  void operator()(const ConfigSchema::Words& words) const { words.store(std::get<WordIndex>(value).index); }

  std::int64_t scaled_whole() const {
    return std::get<std::int64_t>(value) * static_cast<std::int64_t>(std::llround(key.number.scale));
  }
};

}  // namespace

Result<Value> convert(const Key& key, const toml::node& node, const std::filesystem::path& folder) {
  return std::visit(Converter{key, node, folder}, key.field);
}

void store(const Key& key, const Value& value) {
  std::visit(Storer{key, value}, key.field);
}

Result<Value> convert_present(const Key& key) {
  try {
    const toml::table table = toml::parse("value = " + as_toml(key));
    return convert(key, *table.get("value"), {});
  } catch (const toml::parse_error&) {
    return fail(ErrorCode::internal,
                fmt::format("{} has a default that cannot be written as TOML", key.name));
  }
}

}  // namespace linescope::config
