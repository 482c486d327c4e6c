#include "ipc/shared_object.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <grp.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "ipc/process_identity.hpp"

namespace linescope {
namespace {

namespace bip = boost::interprocess;

constexpr double kMebibyte = 1024.0 * 1024.0;

ObjectFacts facts_from(const struct stat& s) {
  return {s.st_dev, s.st_ino, static_cast<std::uint64_t>(s.st_size), s.st_uid, s.st_mode & 07777U};
}

std::string path_of(const std::string& name) {
  return "/dev/shm/" + name;
}

/// The object may be listed although it may not be opened: then at least its owner is known.
ObjectFacts listed(const std::string& path) {
  struct stat s {};
  if (::stat(path.c_str(), &s) != 0) return {};
  return facts_from(s);
}

tl::unexpected<Error> refused(const std::string& name) {
  const ObjectFacts facts = listed(path_of(name));
  return fail(ErrorCode::permission,
              fmt::format("shared memory {} belongs to {} (mode {:o}) and may not be opened by {}: run both "
                          "programs as the same "
                          "user, or start the daemon with --group",
                          name, user_name(facts.owner), facts.mode, user_name(::geteuid())));
}

tl::unexpected<Error> open_failure(const std::string& name, const bip::interprocess_exception& e) {
  switch (e.get_error_code()) {
    case bip::already_exists_error:
      return fail(ErrorCode::busy, fmt::format("shared memory {} exists already", name));
    case bip::not_found_error:
      return fail(ErrorCode::not_found, fmt::format("there is no shared memory {}", name));
    case bip::security_error:
      return refused(name);
    default:
      return fail(ErrorCode::unreadable,
                  fmt::format("shared memory {} cannot be opened: {}", name, e.what()));
  }
}

Result<void> give_to_group(int descriptor, const std::string& group, std::uint32_t mode) {
  if (group.empty()) return {};
  const ::group* entry = ::getgrnam(group.c_str());
  if (entry == nullptr) return fail(ErrorCode::usage, fmt::format("there is no group {}", group));
  if (::fchown(descriptor, static_cast<uid_t>(-1), entry->gr_gid) != 0 || ::fchmod(descriptor, mode) != 0) {
    return fail(ErrorCode::permission,
                fmt::format("the segment cannot be given to group {}: {}", group, std::strerror(errno)));
  }
  return {};
}

}  // namespace

SharedObject::SharedObject(const std::string& name, Access access)
    : name_(name), path_(path_of(name)), access_(access) {}

Result<SharedObject> SharedObject::create(const std::string& name, std::size_t bytes,
                                          const std::string& group, std::uint32_t group_mode) {
  SharedObject made(name, Access::read_write);
  try {
    made.object_ =
        bip::shared_memory_object(bip::create_only, name.c_str(), bip::read_write, bip::permissions(0600));
  } catch (const bip::interprocess_exception& e) {
    return open_failure(name, e);
  }
  Result<void> ok = made.reserve(bytes);
  if (ok) ok = give_to_group(made.descriptor(), group, group_mode);
  if (ok) ok = made.map(bytes, true);
  if (!ok) {
    made.remove_name();
    return tl::unexpected(ok.error());
  }
  return made;
}

Result<SharedObject> SharedObject::open(const std::string& name, Access access) {
  SharedObject opened(name, access);
  try {
    opened.object_ = bip::shared_memory_object(
        bip::open_only, name.c_str(), access == Access::read_only ? bip::read_only : bip::read_write);
  } catch (const bip::interprocess_exception& e) {
    return open_failure(name, e);
  }
  return opened;
}

Result<void> SharedObject::map(std::size_t at_least, bool prefault) {
  const std::uint64_t bytes = facts().bytes;
  if (bytes < at_least) {
    return fail(ErrorCode::unreadable, fmt::format("shared memory {} is {} bytes long, but must have at "
                                                   "least {}: it is truncated or just being set up",
                                                   name_, bytes, at_least));
  }
  const bip::mode_t mode = access_ == Access::read_only ? bip::read_only : bip::read_write;
  try {
    region_ = bip::mapped_region(object_, mode, 0, bytes, nullptr,
                                 prefault ? MAP_POPULATE : bip::default_map_options);
  } catch (const bip::interprocess_exception& e) {
    return fail(ErrorCode::unreadable, fmt::format("shared memory {} cannot be mapped: {}", name_, e.what()));
  }
  return {};
}

Result<void> SharedObject::reserve(std::size_t bytes) const {
  struct statvfs space {};
  ::fstatvfs(descriptor(), &space);
  const std::uint64_t free = std::uint64_t{space.f_bavail} * space.f_frsize;
  // Asked first, because trying would push everybody else's memory out before it fails.
  int error = free < bytes ? ENOSPC : EINTR;
  while (error == EINTR) error = ::posix_fallocate(descriptor(), 0, static_cast<off_t>(bytes));
  if (error == 0) return {};
  return fail(
      ErrorCode::full,
      fmt::format("shared memory {} needs {:.1f} MiB, but /dev/shm has {:.1f} MiB free ({}): free some, "
                  "enlarge it (mount -o remount,size=...), or choose smaller capacities",
                  name_, static_cast<double>(bytes) / kMebibyte, static_cast<double>(free) / kMebibyte,
                  std::strerror(error)));
}

ObjectFacts SharedObject::facts() const {
  struct stat s {};
  if (::fstat(descriptor(), &s) != 0) return {};
  return facts_from(s);
}

ObjectFacts SharedObject::facts_of_name() const {
  return listed(path_);
}

bool SharedObject::owns_its_name() const {
  const ObjectFacts named = facts_of_name();
  return named.inode != 0 && named.same_object(facts());
}

namespace {

/// The kernel's lock on the object (not on its contents) keeps two processes from removing each other's
/// successor. Whoever may open the object may also hold this lock for ever: so waiting for it is bounded.
class NameLock {
 public:
  explicit NameLock(int descriptor) : descriptor_(descriptor) {
    for (int i = 0; i < 200 && ::flock(descriptor_, LOCK_EX | LOCK_NB) != 0; ++i) ::usleep(1000);
  }
  ~NameLock() { ::flock(descriptor_, LOCK_UN); }
  NameLock(const NameLock&) = delete;
  NameLock& operator=(const NameLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace

void SharedObject::remove_name() const {
  const NameLock lock(descriptor());
  if (owns_its_name()) bip::shared_memory_object::remove(name_.c_str());
}

}  // namespace linescope
