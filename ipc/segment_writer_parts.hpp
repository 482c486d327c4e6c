// Inside of SegmentWriter: the two mappings and what each writing thread keeps to itself. Not for users.
#pragma once

#include <array>
#include <string>

#include "ipc/announcer.hpp"
#include "ipc/control_layout.h"
#include "ipc/segment_plan.hpp"
#include "ipc/segment_writer.hpp"
#include "ipc/shared_object.hpp"
#include "ipc/shared_ring.hpp"

namespace linescope {

/// Rings of one kind, one per station or per text.
template <std::size_t N>
using RingWriters = std::array<shared::RingWriter, N>;

struct SegmentWriter::Parts {
  Parts(const SegmentOptions& wanted, SharedObject main, SharedObject control, const SegmentPlan& planned,
        std::uint64_t session);

  ls_header& header() const { return *reinterpret_cast<ls_header*>(segment.data()); }
  ls_control& mailbox() const { return *reinterpret_cast<ls_control*>(control_segment.data()); }
  ls_counter* counters() const;
  ls_latency* latencies() const;
  ls_line_record* line(std::uint32_t index) const;

  void begin_generation(std::uint32_t kept, std::uint64_t points, std::uint32_t cause);
  void set_full(std::uint32_t what);
  void store_line(const ScanLineInfo& info, std::span<const SurfacePoint> points);
  void fetch_next_line() const;
  void note_frame(const PictureInfo& info);

  SegmentOptions options;
  SharedObject segment;
  SharedObject control_segment;
  SegmentPlan plan;
  std::uint64_t session_id;
  shared::Announcer announcer;

  // life
  std::uint64_t beats = 0;
  Nanoseconds last_beat = 0;

  // state
  shared::RingWriter states;
  RingWriters<LS_TEXTS> texts;

  // pose
  RingWriters<LS_STATIONS> poses;
  RingWriters<LS_STATIONS> sensors;

  // line
  shared::RingWriter scans;
  shared::RingWriter pictures;
  shared::RingWriter frames;
  shared::RingWriter cameras;
  std::uint32_t generation = 0;
  std::uint32_t scan_id = 0;
  std::uint32_t lines = 0;
  std::uint64_t points_used = 0;
  std::uint64_t next_serial = 0;
  Nanoseconds scan_started = 0;
  bool scanning = false;
  std::uint32_t full = 0;  ///< as ls_header::full
};

/// Zero-terminated copy into a text field of a record; cut at its end, never inside of a UTF-8 character.
void set_text(char* field, std::size_t size, std::string_view text);

template <std::size_t N>
void set_text(char (&field)[N], std::string_view text) {
  set_text(field, N, text);
}

}  // namespace linescope
