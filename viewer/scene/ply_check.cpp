#include "viewer/scene/ply_check.hpp"

#include <cstdint>
#include <map>
#include <sstream>
#include <vector>

namespace linescope {
namespace {

struct Property {
  std::size_t count_size = 0;  ///< of a list's count; 0: no list
  std::size_t size = 0;
};
struct Element {
  std::uint64_t count = 0;
  std::vector<Property> properties;
};
struct Header {
  std::string format;
  std::vector<Element> elements;
  std::size_t length = 0;  ///< bytes; 0: it has no end
};

std::size_t size_of(const std::string& type) {
  static const std::map<std::string, std::size_t> sizes = {
      {"char", 1},   {"int8", 1},    {"uchar", 1},  {"uint8", 1},  {"short", 2}, {"int16", 2},
      {"ushort", 2}, {"uint16", 2},  {"int", 4},    {"int32", 4},  {"uint", 4},  {"uint32", 4},
      {"float", 4},  {"float32", 4}, {"double", 8}, {"float64", 8}};
  const auto found = sizes.find(type);
  return found == sizes.end() ? 0 : found->second;
}

/// False: a word that is none.
bool take(std::istringstream& words, Header& header) {
  std::string keyword, type, item;
  words >> keyword;
  if (keyword == "format") words >> header.format;
  if (keyword == "element") {
    header.elements.emplace_back();
    words >> type >> header.elements.back().count;
    return !words.fail();
  }
  if (keyword != "property") return true;
  words >> type;
  Property property;
  if (type == "list") {
    words >> type >> item;
    property.count_size = size_of(type);
    if (property.count_size == 0 || property.count_size > 4) return false;
    type = item;
  }
  property.size = size_of(type);
  if (header.elements.empty() || property.size == 0) return false;
  header.elements.back().properties.push_back(property);
  return true;
}

bool read(const std::string& text, Header& header) {
  std::size_t at = 0;
  for (std::size_t end = 0; (end = text.find('\n', at)) != std::string::npos; at = end + 1) {
    std::string line = text.substr(at, end - at);
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line == "end_header") return header.length = end + 1, true;
    std::istringstream words(line);
    if (!take(words, header)) return false;
  }
  return false;
}

std::uint64_t number_at(const std::string& bytes, std::size_t at, std::size_t size, bool big) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < size; ++i)
    value = value << 8 | static_cast<unsigned char>(bytes[at + (big ? i : size - 1 - i)]);
  return value;
}

/// Walks through the rows; false when the bytes end before.
bool long_enough(const Header& header, const std::string& bytes, bool big) {
  std::uint64_t at = header.length;
  for (const Element& element : header.elements)
    for (std::uint64_t row = 0; row < element.count; ++row)
      for (const Property& p : element.properties) {
        std::uint64_t items = 1;
        if (p.count_size > 0) {
          if (at + p.count_size > bytes.size()) return false;
          items = number_at(bytes, at, p.count_size, big);
          at += p.count_size;
        }
        at += items * p.size;
        if (at > bytes.size()) return false;
      }
  return true;
}

bool rows_enough(const Header& header, const std::string& text) {
  std::uint64_t wanted = 0, found = 0;
  for (const Element& element : header.elements) wanted += element.count;
  bool in_row = false;
  for (std::size_t at = header.length; at < text.size(); ++at) {
    if (text[at] == '\n')
      in_row = false;
    else if (text[at] > ' ' && !in_row)
      in_row = true, ++found;
  }
  return found >= wanted;
}

}  // namespace

std::string ply_fault(const std::string& contents) {
  Header header;
  if (contents.compare(0, 3, "ply") != 0) return "it does not begin as a PLY file";
  if (!read(contents, header)) return "its header is incomplete";
  const bool ascii = header.format == "ascii", big = header.format == "binary_big_endian";
  if (!ascii && !big && header.format != "binary_little_endian") return "its format is unknown";
  // A row without properties takes no room: such a header could ask for for ever.
  for (const Element& element : header.elements)
    if (element.properties.empty() && element.count > 0) return "an element has no properties";
  return (ascii ? rows_enough(header, contents) : long_enough(header, contents, big))
             ? std::string()
             : "it ends before its header says";
}

}  // namespace linescope
