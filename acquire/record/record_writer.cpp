#include <fcntl.h>
#include <fmt/format.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <boost/crc.hpp>
#include <cerrno>
#include <cstring>
#include <utility>

#include "acquire/record/record_file.hpp"

namespace linescope {
namespace {

bool no_room(int error) {
  return error == ENOSPC || error == EDQUOT || error == EFBIG;
}

class FileSink final : public RecordSink {
 public:
  FileSink(std::filesystem::path file, int fd) : file_(std::move(file)), fd_(fd) {}
  ~FileSink() override { ::close(fd_); }
  FileSink(const FileSink&) = delete;
  FileSink& operator=(const FileSink&) = delete;

  Result<void> append(std::span<const std::uint8_t> bytes) override {
    for (std::size_t done = 0; done < bytes.size();) {
      const ssize_t n = ::write(fd_, bytes.data() + done, bytes.size() - done);
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) return take_back(n < 0 ? errno : EIO);
      done += static_cast<std::size_t>(n);
    }
    size_ += static_cast<off_t>(bytes.size());
    return {};
  }

  Result<void> sync() override {
    if (::fdatasync(fd_) == 0) return {};
    return failure(errno);
  }

  std::uint64_t free_bytes() const override {
    struct statvfs room {};
    if (::fstatvfs(fd_, &room) != 0) return 0;
    return static_cast<std::uint64_t>(room.f_bavail) * room.f_frsize;
  }

 private:
  Result<void> take_back(int error) {
    if (::ftruncate(fd_, size_) != 0 || ::lseek(fd_, size_, SEEK_SET) < 0) error = errno;
    return failure(error);
  }

  tl::unexpected<Error> failure(int error) const {
    return fail(no_room(error) ? ErrorCode::full : ErrorCode::gone,
                fmt::format("{} cannot be written: {}", file_.string(), std::strerror(error)));
  }

  std::filesystem::path file_;
  int fd_;
  off_t size_ = 0;
};

}  // namespace

std::uint32_t record_crc(std::uint32_t type, std::span<const std::uint8_t> payload) {
  const std::uint32_t head[2] = {type, static_cast<std::uint32_t>(payload.size())};
  boost::crc_32_type crc;
  crc.process_bytes(head, sizeof head);
  crc.process_bytes(payload.data(), payload.size());
  return crc.checksum();
}

Result<std::unique_ptr<RecordSink>> create_record_file(const std::filesystem::path& file) {
  const int fd = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
  if (fd >= 0) return std::make_unique<FileSink>(file, fd);
  const ErrorCode code = errno == EEXIST  ? ErrorCode::busy
                         : no_room(errno) ? ErrorCode::full
                                          : ErrorCode::permission;
  return fail(code, fmt::format("{} cannot be created: {}", file.string(), std::strerror(errno)));
}

RecordWriter::RecordWriter(std::unique_ptr<RecordSink> sink, RecordFileKind kind)
    : sink_(std::move(sink)), kind_(kind) {}

ByteWriter RecordWriter::begin(std::uint32_t type) {
  if (!header_written_ && buffer_.empty()) {
    ByteWriter header(buffer_);
    header.raw(kRecordFileMagic.data(), kRecordFileMagic.size());
    header.put(static_cast<std::uint32_t>(kind_));
    header.put(std::uint32_t{0});
  }
  start_ = buffer_.size();
  ByteWriter record(buffer_);
  record.raw(kRecordSync.data(), kRecordSync.size());
  record.put(type);
  record.put(std::uint64_t{0});  // size and crc, filled in by end()
  return record;
}

void RecordWriter::end() {
  const std::span<const std::uint8_t> payload =
      std::span<const std::uint8_t>(buffer_).subspan(start_ + kRecordHeader);
  std::uint32_t type = 0;
  std::memcpy(&type, &buffer_[start_ + 4], sizeof type);
  const std::uint32_t tail[2] = {static_cast<std::uint32_t>(payload.size()), record_crc(type, payload)};
  std::memcpy(&buffer_[start_ + 8], tail, sizeof tail);
  ++records_;
}

Result<void> RecordWriter::discard() {
  buffer_.clear();
  records_ = 0;
  return fail(ErrorCode::full, "not written");
}

Result<void> RecordWriter::flush() {
  const auto written = sink_->append(buffer_);
  if (written) {
    written_bytes_ += buffer_.size();
    header_written_ = true;
  }
  buffer_.clear();
  records_ = 0;
  return written;
}

}  // namespace linescope
