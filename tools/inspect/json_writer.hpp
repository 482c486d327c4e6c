// Writing JSON: objects and arrays in the order of the calls, strings escaped, numbers that are not finite as
// null.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <string_view>
#include <type_traits>

namespace linescope {

class JsonWriter {
 public:
  void begin_object(std::string_view key = {}) { open(key, '{'); }
  void end_object() { close('}'); }
  void begin_array(std::string_view key = {}) { open(key, '['); }
  void end_array() { close(']'); }

  void add(std::string_view key, std::string_view text) { label(key), quoted(text); }
  void add(std::string_view key, const char* text) { add(key, std::string_view(text)); }
  void add(std::string_view key, bool value) { label(key), text_ += value ? "true" : "false"; }
  template <class Number>
  requires std::is_arithmetic_v<Number>
  void add(std::string_view key, Number value) {
    label(key);
    if constexpr (std::is_floating_point_v<Number>) {
      text_ += std::isfinite(value) ? fmt::format("{}", value) : "null";
    } else {
      text_ += fmt::format("{}", value);
    }
  }
  void add_null(std::string_view key) { label(key), text_ += "null"; }

  const std::string& text() const { return text_; }

 private:
  void open(std::string_view key, char bracket) { label(key), text_ += bracket; }
  void close(char bracket) { text_ += bracket; }
  void label(std::string_view key) {
    if (!text_.empty() && text_.back() != '{' && text_.back() != '[') text_ += ',';
    if (!key.empty()) quoted(key), text_ += ':';
  }
  void quoted(std::string_view raw) {
    text_ += '"';
    for (const char c : raw) {
      if (c == '"' || c == '\\')
        (text_ += '\\') += c;
      else if (static_cast<unsigned char>(c) < 0x20)
        text_ += fmt::format("\\u{:04x}", static_cast<unsigned char>(c));
      else
        text_ += c;
    }
    text_ += '"';
  }

  std::string text_;
};

}  // namespace linescope
