#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "acquire/record/record_file.hpp"

namespace linescope {
namespace {

std::uint32_t number_at(const std::uint8_t* bytes) {
  std::uint32_t number = 0;
  std::memcpy(&number, bytes, sizeof number);
  return number;
}

tl::unexpected<Error> cannot_open(const std::filesystem::path& file, int error) {
  const ErrorCode code = error == ENOENT ? ErrorCode::not_found : ErrorCode::permission;
  return fail(code, fmt::format("{} cannot be read: {}; name the folder of a recording", file.string(),
                                std::strerror(error)));
}

}  // namespace

RecordReader::RecordReader(std::filesystem::path file, int fd, std::uint64_t size)
    : file_(std::move(file)), fd_(fd), size_(size) {}

RecordReader::~RecordReader() {
  if (fd_ >= 0) ::close(fd_);
}

RecordReader::RecordReader(RecordReader&& other) noexcept
    : file_(std::move(other.file_)),
      fd_(std::exchange(other.fd_, -1)),
      size_(other.size_),
      position_(other.position_),
      unfinished_(other.unfinished_) {}

RecordReader& RecordReader::operator=(RecordReader&& other) noexcept {
  std::swap(fd_, other.fd_);
  file_ = std::move(other.file_);
  size_ = other.size_;
  position_ = other.position_;
  unfinished_ = other.unfinished_;
  return *this;
}

Result<RecordReader> RecordReader::open(const std::filesystem::path& file, RecordFileKind kind) {
  const int fd = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return cannot_open(file, errno);
  struct stat info {};
  ::fstat(fd, &info);
  RecordReader reader(file, fd, static_cast<std::uint64_t>(std::max<off_t>(info.st_size, 0)));
  if (reader.size_ == 0) return reader;  // created, and the process was killed before its first record

  return checked_header(std::move(reader), kind);
}

/// A damaged beginning is damage like any other, as long as there is a record behind it.
Result<RecordReader> RecordReader::checked_header(RecordReader reader, RecordFileKind kind) {
  std::array<std::uint8_t, kRecordFileHeader> header{};
  Record first;
  const bool magic = reader.read_at(0, header) &&
                     std::equal(kRecordFileMagic.begin(), kRecordFileMagic.end() - 2, header.begin());
  if (!magic && reader.find_record(0, first) == reader.size_) {
    return fail(ErrorCode::unreadable,
                fmt::format("{} is not a recording, or too much of it is damaged", reader.file_.string()));
  }
  if (!magic) {
    reader.position_ = 0;
    return reader;
  }
  if (header[6] != kRecordFileMagic[6] || number_at(&header[8]) != static_cast<std::uint32_t>(kind)) {
    return fail(
        ErrorCode::mismatch,
        fmt::format(
            "{} was written by another version or holds something else; replay it with the version that "
            "recording.toml names",
            reader.file_.string()));
  }
  return reader;
}

bool RecordReader::read_at(std::uint64_t offset, std::span<std::uint8_t> out) const {
  if (offset + out.size() > size_) return false;
  for (std::size_t done = 0; done < out.size();) {
    const ssize_t n = ::pread(fd_, out.data() + done, out.size() - done, static_cast<off_t>(offset + done));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    done += static_cast<std::size_t>(n);
  }
  return true;
}

bool RecordReader::read_record(std::uint64_t offset, Record& record) const {
  std::array<std::uint8_t, kRecordHeader> header{};
  if (!read_at(offset, header)) return false;
  const std::uint32_t size = number_at(&header[8]);
  const bool sane = std::equal(kRecordSync.begin(), kRecordSync.end(), header.begin()) &&
                    size <= kLargestPayload && offset + kRecordHeader + size <= size_;
  if (!sane) return false;
  record.type = number_at(&header[4]);
  record.offset = offset;
  record.payload.resize(size);
  return read_at(offset + kRecordHeader, record.payload) &&
         record_crc(record.type, record.payload) == number_at(&header[12]);
}

/// Offset of the first whole record at or behind `from`, or the file's size.
std::uint64_t RecordReader::find_record(std::uint64_t from, Record& record) const {
  std::array<std::uint8_t, 65536> block{};
  while (from + kRecordHeader <= size_) {
    const std::size_t size = static_cast<std::size_t>(std::min<std::uint64_t>(block.size(), size_ - from));
    const auto bytes = std::span(block).first(size);
    if (!read_at(from, bytes)) break;
    for (auto at = bytes.begin();; ++at) {
      at = std::search(at, bytes.end(), kRecordSync.begin(), kRecordSync.end());
      if (at == bytes.end()) break;
      const std::uint64_t offset = from + static_cast<std::uint64_t>(at - bytes.begin());
      if (read_record(offset, record)) return offset;
    }
    from += size - (kRecordSync.size() - 1);
  }
  return size_;
}

Result<Pull> RecordReader::next(Record& record) {
  if (position_ >= size_) return Pull::end;
  if (read_record(position_, record)) {
    position_ += kRecordHeader + record.payload.size();
    return Pull::item;
  }
  const std::uint64_t damaged = position_;
  position_ = find_record(position_ + 1, record);
  if (position_ == size_) {
    unfinished_ = size_ - damaged;
    return Pull::end;
  }
  return fail(ErrorCode::unreadable, fmt::format("{} is damaged from byte {} to {}; that part is passed over",
                                                 file_.string(), damaged, position_));
}

}  // namespace linescope
