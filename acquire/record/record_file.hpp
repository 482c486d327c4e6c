// A file of checked records: what was written stays readable whatever happens afterwards.
//
//   file   = "lsrec 1\n"  kind (u32)  0 (u32)  record*
//   record = "LSr\n"  type (u32)  size (u32)  crc (u32)  payload (size bytes)
//
// All numbers little-endian; crc is CRC-32 (IEEE 802.3) over type, size and payload. Records go to the kernel
// whole, so that a killed process loses none of them; a record that did not fit is cut off again, so that the
// file always ends at the end of a record. docs/recording.md has the payloads.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "acquire/pull.hpp"
#include "acquire/record/byte_codec.hpp"
#include "common/result.hpp"

namespace linescope {

inline constexpr std::array<std::uint8_t, 8> kRecordFileMagic{'l', 's', 'r', 'e', 'c', ' ', '1', '\n'};
inline constexpr std::array<std::uint8_t, 4> kRecordSync{'L', 'S', 'r', '\n'};
inline constexpr std::size_t kRecordFileHeader = 16;
inline constexpr std::size_t kRecordHeader = 16;
/// Nothing larger is ever written; a larger size in a file is damage.
inline constexpr std::uint32_t kLargestPayload = 1U << 30;

enum class RecordFileKind : std::uint32_t { pictures = 1, tracker = 2 };

/// Where the bytes go. Real: a file. In tests: a disk that is full or slow.
class RecordSink {
 public:
  virtual ~RecordSink() = default;
  /// All of `bytes` or nothing: after a failure the file ends where it ended before. `full`: no room (disk,
  /// quota, file size limit); anything else: the disk itself fails.
  virtual Result<void> append(std::span<const std::uint8_t> bytes) = 0;
  /// Down to the disk, against power failure. May take long.
  virtual Result<void> sync() = 0;
  virtual std::uint64_t free_bytes() const = 0;
};

/// Creates the file; refuses an existing one.
Result<std::unique_ptr<RecordSink>> create_record_file(const std::filesystem::path& file);

/// Collects records and hands them to the sink in one piece.
class RecordWriter {
 public:
  RecordWriter(std::unique_ptr<RecordSink> sink, RecordFileKind kind);

  /// The buffer for the next record's payload; end() completes it.
  ByteWriter begin(std::uint32_t type);
  Bytes& buffer() { return buffer_; }
  void end();
  std::size_t pending() const { return records_; }

  /// Writes everything pending; after a failure the pending records are gone and the file is as before.
  Result<void> flush();
  /// Forgets everything pending; says `full`.
  Result<void> discard();
  Result<void> sync() { return sink_->sync(); }
  std::uint64_t written_bytes() const { return written_bytes_; }
  std::uint64_t free_bytes() const { return sink_->free_bytes(); }

 private:
  std::unique_ptr<RecordSink> sink_;
  RecordFileKind kind_;
  bool header_written_ = false;
  Bytes buffer_;
  std::size_t start_ = 0;  ///< of the record being made
  std::size_t records_ = 0;
  std::uint64_t written_bytes_ = 0;
};

/// CRC-32 (IEEE 802.3) of a record.
std::uint32_t record_crc(std::uint32_t type, std::span<const std::uint8_t> payload);

struct Record {
  std::uint32_t type = 0;
  Bytes payload;
  std::uint64_t offset = 0;  ///< of the record in the file
};

/// Reads from the beginning, steps over damage, stops at the end. One thread.
class RecordReader {
 public:
  /// not_found, permission, unreadable (empty or something else), mismatch (other kind or format version).
  static Result<RecordReader> open(const std::filesystem::path& file, RecordFileKind kind);
  ~RecordReader();
  RecordReader(RecordReader&&) noexcept;
  RecordReader& operator=(RecordReader&&) noexcept;

  /// item, or end. Damage is an error `unreadable` that says where and how many bytes; the next call goes on
  /// behind it.
  Result<Pull> next(Record& record);

  /// After `end`: bytes of an unfinished record at the end of the file (a process that was killed), else 0.
  std::uint64_t unfinished_bytes() const { return unfinished_; }

 private:
  RecordReader(std::filesystem::path file, int fd, std::uint64_t size);
  static Result<RecordReader> checked_header(RecordReader reader, RecordFileKind kind);
  bool read_at(std::uint64_t offset, std::span<std::uint8_t> out) const;
  bool read_record(std::uint64_t offset, Record& record) const;
  std::uint64_t find_record(std::uint64_t from, Record& record) const;

  std::filesystem::path file_;
  int fd_ = -1;
  std::uint64_t size_ = 0;
  std::uint64_t position_ = kRecordFileHeader;
  std::uint64_t unfinished_ = 0;
};

}  // namespace linescope
