// A shared-memory object with any bytes in it: what an accident, another program or an enemy may have left
// under our name.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstring>
#include <string>
#include <vector>

#include "ipc/segment_layout.h"

namespace linescope::testing {

class RawObject {
 public:
  explicit RawObject(std::string name) : name_(std::move(name)) {}
  ~RawObject() { ::shm_unlink(name_.c_str()); }
  RawObject(const RawObject&) = delete;
  RawObject& operator=(const RawObject&) = delete;

  /// Makes the object anew (another inode) with these bytes.
  void set(const std::vector<std::byte>& bytes, unsigned mode = 0600) const {
    ::shm_unlink(name_.c_str());
    const int fd = ::shm_open(name_.c_str(), O_CREAT | O_EXCL | O_RDWR, 0600);
    ASSERT_GE(fd, 0);
    ASSERT_EQ(::write(fd, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
    ASSERT_EQ(::fchmod(fd, mode), 0);
    ::close(fd);
  }

  static std::vector<std::byte> bytes_of(const std::string& name) {
    const int fd = ::shm_open(name.c_str(), O_RDONLY, 0);
    struct stat s {};
    ::fstat(fd, &s);
    std::vector<std::byte> bytes(static_cast<std::size_t>(s.st_size));
    EXPECT_EQ(::read(fd, bytes.data(), bytes.size()), s.st_size);
    ::close(fd);
    return bytes;
  }

  const std::string& name() const { return name_; }

 private:
  std::string name_;
};

/// The header at the start of a copied segment, to be damaged.
inline ls_header& header_of(std::vector<std::byte>& bytes) {
  return *reinterpret_cast<ls_header*>(bytes.data());
}

inline bool exists(const std::string& name) {
  struct stat s {};
  return ::stat(("/dev/shm/" + name).c_str(), &s) == 0;
}

}  // namespace linescope::testing
