#include "acquire/tracker/liberty/output_list.hpp"

#include <fmt/format.h>

namespace linescope {

OutputList OutputList::for_options(const LibertyOptions& options) {
  OutputList list;
  list.add(OutputItem::frame_count);
  if (options.ask_timestamp) list.add(OutputItem::timestamp);
  if (options.ask_distortion) list.add(OutputItem::distortion);
  if (options.ask_stylus) list.add(OutputItem::stylus);
  list.add(OutputItem::position);
  list.add(OutputItem::quaternion);
  if (options.format == LibertyFormat::ascii) list.add(OutputItem::line_end);
  return list;
}

void OutputList::add(OutputItem item) {
  if (size_ < kMost) items_[size_++] = item;
}

std::size_t OutputList::body_size() const {
  std::size_t sum = 0;
  for (const OutputItem item : items()) sum += binary_size(item);
  return sum;
}

std::optional<std::size_t> OutputList::offset_of(OutputItem wanted) const {
  std::size_t offset = 0;
  for (const OutputItem item : items()) {
    if (item == wanted) return offset;
    offset += binary_size(item);
  }
  return std::nullopt;
}

std::string OutputList::text() const {
  std::string text;
  for (const OutputItem item : items())
    text += fmt::format("{}{}", text.empty() ? "" : ",", static_cast<int>(item));
  return text;
}

}  // namespace linescope
