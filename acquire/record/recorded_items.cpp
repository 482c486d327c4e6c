#include "acquire/record/recorded_items.hpp"

#include <fmt/format.h>

namespace linescope {
namespace {

/// Larger than any camera; more is damage.
constexpr std::uint32_t kLargestSide = 16384;

tl::unexpected<Error> broken(const Record& record, std::string_view what) {
  return fail(ErrorCode::unreadable,
              fmt::format("the {} at byte {} of the recording is not readable; it is passed over", what,
                          record.offset));
}

template <class To, class From>
void put(ByteWriter& out, const Rigid<To, From>& pose) {
  for (const double number : pose.rotation().coeffs()) out.put(number);
  for (const double number : pose.translation()) out.put(number);
}

template <class To, class From>
Rigid<To, From> get_rigid(ByteReader& in) {
  Eigen::Quaterniond rotation;
  Eigen::Vector3d translation;
  for (double& number : rotation.coeffs()) number = in.get<double>();
  for (double& number : translation) number = in.get<double>();
  return Rigid<To, From>::from_unit(rotation, translation);
}

void put(ByteWriter& out, const Eigen::Vector3d& vector) {
  for (const double number : vector) out.put(number);
}

Eigen::Vector3d get_vector(ByteReader& in) {
  Eigen::Vector3d vector;
  for (double& number : vector) number = in.get<double>();
  return vector;
}

void put(ByteWriter& out, const CameraModel& camera) {
  out.put(camera.width);
  out.put(camera.height);
  for (const double number : {camera.fx, camera.fy, camera.skew, camera.cx, camera.cy}) out.put(number);
  for (const double number : camera.distortion) out.put(number);
}

CameraModel get_camera(ByteReader& in) {
  CameraModel camera;
  camera.width = in.get<int>();
  camera.height = in.get<int>();
  for (double* number : {&camera.fx, &camera.fy, &camera.skew, &camera.cx, &camera.cy})
    *number = in.get<double>();
  for (double& number : camera.distortion) number = in.get<double>();
  return camera;
}

PictureHead get_head(ByteReader& in) {
  PictureHead head;
  head.time = in.get<Nanoseconds>();
  head.index = in.get<std::uint64_t>();
  const auto width = in.get<std::uint32_t>(), height = in.get<std::uint32_t>();
  const bool sane = width > 0 && height > 0 && width <= kLargestSide && height <= kLargestSide;
  head.width = sane ? static_cast<int>(width) : 0;
  head.height = sane ? static_cast<int>(height) : 0;
  return head;
}

}  // namespace

void add_record(RecordWriter& writer, const Frame& frame, PictureEncoding encoding, PictureCodec& codec) {
  ByteWriter out = writer.begin(static_cast<std::uint32_t>(RecordType::picture));
  out.put(frame.time);
  out.put(frame.index);
  out.put(static_cast<std::uint32_t>(frame.bgr.cols));
  out.put(static_cast<std::uint32_t>(frame.bgr.rows));
  out.put(static_cast<std::uint32_t>(encoding));
  out.text(frame.name);
  codec.encode(frame.bgr, encoding, writer.buffer());
  writer.end();
}

void add_record(RecordWriter& writer, const PoseSample& sample) {
  ByteWriter out = writer.begin(static_cast<std::uint32_t>(RecordType::sample));
  out.put(sample.time);
  out.put(sample.arrival);
  out.put(sample.frame_count);
  out.put(sample.station);
  out.put(static_cast<std::uint8_t>(sample.state));
  out.put(sample.distortion);
  put(out, sample.world_from_sensor);
  writer.end();
}

void add_record(RecordWriter& writer, const RecordedEvent& event) {
  ByteWriter out = writer.begin(static_cast<std::uint32_t>(RecordType::event));
  out.put(event.time);
  out.text(event.text);
  writer.end();
}

void add_record(RecordWriter& writer, const Calibration& calibration) {
  ByteWriter out = writer.begin(static_cast<std::uint32_t>(RecordType::calibration));
  out.text(calibration.name);
  put(out, calibration.camera);
  put(out, calibration.laser.normal);
  out.put(calibration.laser.offset);
  put(out, calibration.endoscope_from_camera);
  put(out, calibration.harvester.tip);
  put(out, calibration.harvester.axis);
  out.put(calibration.camera_latency);
  out.put(static_cast<std::uint32_t>(calibration.notes.size()));
  for (const std::string& note : calibration.notes) out.text(note);
  if (!calibration.laser_bend.flat())
    for (const double term : calibration.laser_bend.b) out.put(term);
  writer.end();
}

Result<PictureHead> read_picture_head(const Record& record) {
  ByteReader in(record.payload);
  const PictureHead head = get_head(in);
  if (!in.ok() || head.width == 0) return broken(record, "picture");
  return head;
}

Result<void> read_picture(const Record& record, PictureCodec& codec, Frame& frame) {
  ByteReader in(record.payload);
  const PictureHead head = get_head(in);
  const auto encoding = static_cast<PictureEncoding>(in.get<std::uint32_t>());
  const std::string name = in.text();
  if (!in.ok() || head.width == 0) return broken(record, "picture");
  if (!codec.decode(in.rest(), encoding, head.width, head.height, frame.bgr))
    return broken(record, "picture");
  frame.time = head.time;
  frame.index = head.index;
  frame.name = name;
  return {};
}

Result<PoseSample> read_sample(const Record& record) {
  ByteReader in(record.payload);
  PoseSample sample;
  sample.time = in.get<Nanoseconds>();
  sample.arrival = in.get<Nanoseconds>();
  sample.frame_count = in.get<std::uint32_t>();
  sample.station = in.get<std::uint8_t>();
  sample.state = static_cast<ToolState>(in.get<std::uint8_t>());
  sample.distortion = in.get<float>();
  sample.world_from_sensor = get_rigid<World, Sensor>(in);
  if (in.ok() && sample.station < kMaxStations && sample.state <= ToolState::never_seen) return sample;
  return broken(record, "tracker sample");
}

Result<RecordedEvent> read_event(const Record& record) {
  ByteReader in(record.payload);
  RecordedEvent event;
  event.time = in.get<Nanoseconds>();
  event.text = in.text();
  if (in.ok()) return event;
  return broken(record, "event");
}

Result<Calibration> read_calibration(const Record& record) {
  ByteReader in(record.payload);
  Calibration calibration;
  calibration.name = in.text();
  calibration.camera = get_camera(in);
  calibration.laser.normal = get_vector(in);
  calibration.laser.offset = in.get<double>();
  calibration.endoscope_from_camera = get_rigid<Endoscope, CameraCv>(in);
  calibration.harvester.tip = get_vector(in);
  calibration.harvester.axis = get_vector(in);
  calibration.camera_latency = in.get<Nanoseconds>();
  const auto notes = in.get<std::uint32_t>();
  for (std::uint32_t i = 0; i < notes && in.ok(); ++i) calibration.notes.push_back(in.text());
  if (in.left() > 0)
    for (double& term : calibration.laser_bend.b) term = in.get<double>();
  if (in.ok()) return calibration;
  return broken(record, "calibration");
}

}  // namespace linescope
