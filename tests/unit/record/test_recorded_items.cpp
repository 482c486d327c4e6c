#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "acquire/record/recorded_items.hpp"
#include "tests/unit/record/sample_data.hpp"

namespace linescope {
namespace {

using testing::same_bits;

/// Keeps the bytes instead of writing them.
class MemorySink final : public RecordSink {
 public:
  explicit MemorySink(Bytes& bytes) : bytes_(bytes) {}
  Result<void> append(std::span<const std::uint8_t> bytes) override {
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    return {};
  }
  Result<void> sync() override { return {}; }
  std::uint64_t free_bytes() const override { return 1U << 30; }

 private:
  Bytes& bytes_;
};

/// The only record that `add` made.
template <class Add>
Record recorded(Add add) {
  Bytes bytes;
  RecordWriter writer(std::make_unique<MemorySink>(bytes), RecordFileKind::tracker);
  add(writer);
  EXPECT_TRUE(writer.flush());
  Record record;
  std::memcpy(&record.type, &bytes[kRecordFileHeader + 4], 4);
  record.payload.assign(bytes.begin() + kRecordFileHeader + kRecordHeader, bytes.end());
  return record;
}

TEST(RecordedItems, SamplesKeepEveryBit) {
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const PoseSample sample = testing::made_sample(i);
    const auto back = read_sample(recorded([&](RecordWriter& w) { add_record(w, sample); }));
    ASSERT_TRUE(back);
    ASSERT_TRUE(same_bits(sample, *back)) << i;
  }
}

TEST(RecordedItems, CalibrationKeepsEveryBit) {
  const Calibration c = testing::made_calibration();
  const auto back = read_calibration(recorded([&](RecordWriter& w) { add_record(w, c); }));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->name, c.name);
  EXPECT_EQ(back->camera.width, c.camera.width);
  EXPECT_EQ(back->camera.height, c.camera.height);
  for (const auto member :
       {&CameraModel::fx, &CameraModel::fy, &CameraModel::skew, &CameraModel::cx, &CameraModel::cy}) {
    EXPECT_TRUE(same_bits(back->camera.*member, c.camera.*member));
  }
  EXPECT_EQ(back->camera.distortion, c.camera.distortion);
  EXPECT_EQ(back->laser.normal, c.laser.normal);
  EXPECT_TRUE(same_bits(back->laser.offset, c.laser.offset));
  EXPECT_TRUE(same_bits(back->endoscope_from_camera, c.endoscope_from_camera));
  EXPECT_EQ(back->harvester.tip, c.harvester.tip);
  EXPECT_EQ(back->harvester.axis, c.harvester.axis);
  EXPECT_EQ(back->camera_latency, c.camera_latency);
  EXPECT_EQ(back->notes, c.notes);
}

TEST(RecordedItems, PicturesKeepEveryBit) {
  PictureCodec codec;
  for (std::uint64_t i = 0; i < 4; ++i) {
    const Frame frame = testing::made_frame(i);
    const auto encoding = i < 2 ? PictureEncoding::row_zstd : PictureEncoding::plain;
    const Record record = recorded([&](RecordWriter& w) { add_record(w, frame, encoding, codec); });
    Frame back;
    ASSERT_TRUE(read_picture(record, codec, back));
    EXPECT_TRUE(same_bits(frame, back));
    const auto head = read_picture_head(record);
    ASSERT_TRUE(head);
    EXPECT_EQ(head->time, frame.time);
    EXPECT_EQ(head->index, frame.index);
    EXPECT_EQ(head->width, frame.bgr.cols);
  }
}

TEST(RecordedItems, EventsKeepTheirText) {
  const auto back = read_event(recorded([](RecordWriter& w) {
    add_record(w, RecordedEvent{-5, "exposure 3 ms, µ\n"});
  }));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->time, -5);
  EXPECT_EQ(back->text, "exposure 3 ms, µ\n");
}

/// A checksum that fits says nothing about a file from a newer version: every shorter payload must be
/// refused.
TEST(RecordedItems, ShortenedPayloadsAreRefused) {
  PictureCodec codec;
  const auto shortened = [](Record record, std::size_t size) {
    record.payload.resize(size);
    return record;
  };
  const Record sample = recorded([](RecordWriter& w) { add_record(w, testing::made_sample(3)); });
  for (std::size_t n = 0; n < sample.payload.size(); ++n)
    EXPECT_FALSE(read_sample(shortened(sample, n))) << n;
  const Record calibration = recorded([](RecordWriter& w) { add_record(w, testing::made_calibration()); });
  for (std::size_t n = 0; n < calibration.payload.size(); ++n) {
    EXPECT_FALSE(read_calibration(shortened(calibration, n))) << n;
  }
  const Record event = recorded([](RecordWriter& w) { add_record(w, RecordedEvent{1, "text"}); });
  for (std::size_t n = 0; n < event.payload.size(); ++n) EXPECT_FALSE(read_event(shortened(event, n))) << n;
  const Record picture = recorded([&](RecordWriter& w) {
    add_record(w, testing::made_frame(1, 8, 6), PictureEncoding::row_zstd, codec);
  });
  Frame frame;
  for (std::size_t n = 0; n < picture.payload.size(); ++n)
    EXPECT_FALSE(read_picture(shortened(picture, n), codec, frame));
}

TEST(RecordedItems, ImpossibleNumbersAreRefused) {
  PictureCodec codec;
  Record sample = recorded([](RecordWriter& w) { add_record(w, testing::made_sample(3)); });
  sample.payload[20] = 9;  // station
  EXPECT_EQ(read_sample(sample).error().code, ErrorCode::unreadable);
  Record state = recorded([](RecordWriter& w) { add_record(w, testing::made_sample(3)); });
  state.payload[21] = 200;
  EXPECT_FALSE(read_sample(state));
  Record picture = recorded(
      [&](RecordWriter& w) { add_record(w, testing::made_frame(1, 8, 6), PictureEncoding::plain, codec); });
  for (std::size_t i = 16; i < 20; ++i) picture.payload[i] = 0xFF;  // width
  Frame frame;
  EXPECT_FALSE(read_picture(picture, codec, frame));
}

TEST(RecordedItems, ABentLaserSurfaceKeepsEveryBitToo) {
  Calibration c = testing::made_calibration();
  c.laser_bend.b = {1.0 / 3, -0.01, 0.02, 1e-300, -0.03, 0.002, 1.0 / 7};
  Record record = recorded([&](RecordWriter& w) { add_record(w, c); });
  const auto back = read_calibration(record);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->laser_bend.b, c.laser_bend.b);
  EXPECT_EQ(back->notes, c.notes);
  record.payload.pop_back();
  EXPECT_FALSE(read_calibration(record));
}

}  // namespace
}  // namespace linescope
