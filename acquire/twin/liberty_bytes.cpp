#include "acquire/twin/liberty_bytes.hpp"

#include <bit>
#include <cstring>

namespace linescope::twin {
namespace {

using Bytes = std::vector<std::uint8_t>;

static_assert(std::endian::native == std::endian::little, "the LIBERTY sends little endian numbers");

template <class T>
void append(Bytes& bytes, T value) {
  const std::size_t end = bytes.size();
  bytes.resize(end + sizeof value);
  std::memcpy(bytes.data() + end, &value, sizeof value);
}

void append_item(OutputItem item, const LibertyRecord& record, Bytes& bytes) {
  const Eigen::Vector3d& place = record.world_from_sensor.translation();
  const Eigen::Quaterniond& turn = record.world_from_sensor.rotation();
  switch (item) {
    case OutputItem::frame_count:
      return append(bytes, record.frame_count);
    case OutputItem::timestamp:
      return append(bytes, record.milliseconds);
    case OutputItem::position:
      for (int i = 0; i < 3; ++i) append(bytes, static_cast<float>(place[i] / 10));
      return;
    case OutputItem::quaternion:
      for (const double q : {turn.w(), turn.x(), turn.y(), turn.z()}) append(bytes, static_cast<float>(q));
      return;
    default:  // no metal near by, no button pressed
      bytes.resize(bytes.size() + binary_size(item));
  }
}

}  // namespace

void append_record(const LibertyRecord& record, const OutputList& list, Bytes& bytes) {
  bytes.insert(bytes.end(), {'L', 'Y', static_cast<std::uint8_t>(record.station + 1), 'C', record.error, 0});
  append(bytes, static_cast<std::int16_t>(list.body_size()));
  for (const OutputItem item : list.items()) append_item(item, record, bytes);
}

}  // namespace linescope::twin
