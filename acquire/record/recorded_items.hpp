// What stands in the records of a recording: pictures, tracker samples, events, the calibration. Every number
// comes back with the same bits.
#pragma once

#include <cstdint>
#include <string>

#include "acquire/camera/camera_source.hpp"
#include "acquire/record/picture_codec.hpp"
#include "acquire/record/record_file.hpp"
#include "common/calibration.hpp"
#include "common/pose_sample.hpp"

namespace linescope {

/// The numbers stand in files.
enum class RecordType : std::uint32_t { picture = 1, sample = 2, event = 3, calibration = 4 };

/// Something worth knowing when the recording is looked at later: a command, a lost sensor, a changed
/// exposure.
struct RecordedEvent {
  Nanoseconds time = 0;
  std::string text;
};

void add_record(RecordWriter& writer, const Frame& frame, PictureEncoding encoding, PictureCodec& codec);
void add_record(RecordWriter& writer, const PoseSample& sample);
void add_record(RecordWriter& writer, const RecordedEvent& event);
void add_record(RecordWriter& writer, const Calibration& calibration);

/// Precondition: the record has the type in question. `unreadable` when its bytes do not make such an item (a
/// file from a newer version, or damage that the checksum did not see).
Result<void> read_picture(const Record& record, PictureCodec& codec, Frame& frame);
Result<PoseSample> read_sample(const Record& record);
Result<RecordedEvent> read_event(const Record& record);
Result<Calibration> read_calibration(const Record& record);

/// Time and running number of a picture without decoding its pixels.
struct PictureHead {
  Nanoseconds time = 0;
  std::uint64_t index = 0;
  int width = 0;   ///< px
  int height = 0;  ///< px
};
Result<PictureHead> read_picture_head(const Record& record);

}  // namespace linescope
