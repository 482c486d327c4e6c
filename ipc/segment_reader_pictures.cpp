#include "ipc/segment_reader_parts.hpp"

namespace linescope {
namespace {

/// Everything that is used as a size below, against the slot it lies in.
bool plausible(const ls_picture_record& r, std::uint32_t most_samples, std::size_t slot_bytes) {
  if (r.format != LS_PIXELS_GRAY8 && r.format != LS_PIXELS_BGR8) return false;
  const std::uint64_t row = std::uint64_t{r.width} * bytes_per_pixel(static_cast<PixelFormat>(r.format));
  const std::uint64_t room = slot_bytes - sizeof r - std::uint64_t{most_samples} * sizeof(ls_line_sample);
  return r.stride % 8 == 0 && row <= r.stride && std::uint64_t{r.stride} * r.height <= room &&
         r.sample_count <= most_samples;
}

void describe(const ls_picture_record& r, Picture& out) {
  out.time = r.time_ns;
  out.frame = r.frame;
  out.number = r.index + 1;
  out.width = r.width;
  out.height = r.height;
  out.stride = r.stride;
  out.format = static_cast<PixelFormat>(r.format);
  out.name = text_of(r.name);
}

void copy(const ls_picture_record& r, const std::byte* at, std::uint32_t most_samples, Picture& out) {
  at += sizeof r;
  out.samples.resize(r.sample_count);
  shared::copy_out(out.samples.data(), at, r.sample_count * sizeof(PictureSample) / 8);
  at += most_samples * sizeof(PictureSample);
  out.pixels.resize(std::size_t{r.stride} * r.height);
  shared::copy_out(out.pixels.data(), at, out.pixels.size() / 8);
}

}  // namespace

ReadOutcome SegmentReader::picture(Picture& out) const {
  if (!parts_->intact()) return ReadOutcome::corrupt;
  const shared::RingOut ring = parts_->ring(LS_SECTION_PICTURES);
  const std::uint32_t most_samples = parts_->picture_samples;
  for (int i = 0; i < shared::kTries; ++i) {
    const std::uint64_t head = shared::load(ring.head());
    if (head == 0 || head == out.number) return ReadOutcome::nothing;
    ls_picture_record r;
    shared::get(r, shared::RingOut::as<ls_picture_record>(ring.place(head - 1)));
    if (!ring.intact(head - 1)) continue;
    if (r.index != head - 1 || !plausible(r, most_samples, ring.record_bytes())) return ReadOutcome::corrupt;
    copy(r, ring.place(head - 1), most_samples, out);
    if (!ring.intact(head - 1)) continue;
    describe(r, out);
    return ReadOutcome::ok;
  }
  return ReadOutcome::overtaken;
}

}  // namespace linescope
