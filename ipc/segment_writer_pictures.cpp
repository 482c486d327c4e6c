// What the camera's thread publishes: pictures and the camera's status.
#include <algorithm>
#include <cstring>

#include "ipc/segment_writer.hpp"
#include "ipc/segment_writer_parts.hpp"

namespace linescope {
namespace {

/// One row; the last word is filled up with zeros, so that nothing beyond the row is read.
void put_row(std::byte* to, const std::byte* from, std::size_t bytes) {
  const std::size_t whole = bytes / 8;
  shared::copy_in(to, from, whole);
  if (bytes % 8 == 0) return;
  std::uint64_t tail = 0;
  std::memcpy(&tail, from + whole * 8, bytes % 8);
  shared::copy_in(to + whole * 8, &tail, 1);
}

ls_picture_record record_of(const PictureInfo& info, std::uint64_t index, std::uint32_t samples) {
  ls_picture_record r{};
  r.index = index;
  r.time_ns = info.time;
  r.frame = info.frame;
  r.width = info.width;
  r.height = info.height;
  r.stride = picture_stride(info.width, bytes_per_pixel(info.format));
  r.format = static_cast<std::uint32_t>(info.format);
  r.sample_count = samples;
  set_text(r.name, info.name);
  return r;
}

}  // namespace

void SegmentWriter::Parts::note_frame(const PictureInfo& info) {
  ls_frame_record r{};
  r.time_ns = info.time;
  r.frame = info.frame;
  r.published_ns = monotonic_now();
  frames.publish(r);
}

bool SegmentWriter::publish_picture(const PictureInfo& info, const std::byte* pixels, std::size_t stride,
                                    std::span<const PictureSample> samples) {
  Parts& p = *parts_;
  const std::size_t row_bytes = std::size_t{info.width} * bytes_per_pixel(info.format);
  const std::size_t shared_stride = picture_stride(info.width, bytes_per_pixel(info.format));
  if (shared_stride * info.height > p.options.picture_bytes) {
    count(Counter::pictures_too_large);
    p.note_frame(info);
    return false;
  }
  const std::size_t kept = std::min<std::size_t>(samples.size(), p.options.picture_samples);
  count(Counter::picture_samples_dropped, samples.size() - kept);
  std::byte* at = p.pictures.place();
  shared::put(*reinterpret_cast<ls_picture_record*>(at),
              record_of(info, p.pictures.next(), static_cast<std::uint32_t>(kept)));
  at += sizeof(ls_picture_record);
  shared::copy_in(at, samples.data(), kept * sizeof(PictureSample) / 8);
  at += p.options.picture_samples * sizeof(PictureSample);
  for (std::uint32_t y = 0; y < info.height; ++y)
    put_row(at + shared_stride * y, pixels + stride * y, row_bytes);
  p.pictures.publish();
  p.note_frame(info);
  count(Counter::pictures_published);
  p.announcer.announce(Topic::pictures);
  return true;
}

void SegmentWriter::set_camera_status(const CameraReport& status) {
  ls_camera_record r{};
  r.time_ns = status.time;
  r.last_good_ns = status.last_good;
  r.frames = status.frames;
  r.state = static_cast<std::uint32_t>(status.state);
  r.width = status.width;
  r.height = status.height;
  r.nominal_hz = status.nominal_hz;
  r.exposure_ms = status.exposure_ms;
  set_text(r.name, status.name);
  set_text(r.reason, status.reason);
  parts_->cameras.publish(r);
  parts_->announcer.announce(Topic::status);
}

}  // namespace linescope
