// A named shared-memory object and its mapping (Boost.Interprocess), with what the operating system knows
// about it.
#pragma once

#include <boost/interprocess/mapped_region.hpp>
#include <boost/interprocess/shared_memory_object.hpp>
#include <cstddef>
#include <cstdint>
#include <string>

#include "common/result.hpp"

namespace linescope {

/// What the file system says about an object.
struct ObjectFacts {
  std::uint64_t device = 0;
  std::uint64_t inode = 0;
  std::uint64_t bytes = 0;
  std::uint32_t owner = 0;
  std::uint32_t mode = 0;

  bool same_object(const ObjectFacts& other) const { return device == other.device && inode == other.inode; }
};

enum class Access { read_only, read_write };

class SharedObject {
 public:
  /// Makes a new object, only if there is none of this name (`busy` otherwise), for this user and, when
  /// `group` is not empty, for that group with the rights of `group_mode`. All pages are reserved (`full`
  /// otherwise) and zero.
  static Result<SharedObject> create(const std::string& name, std::size_t bytes, const std::string& group,
                                     std::uint32_t group_mode);

  /// Opens an existing one without mapping it. not_found, permission.
  static Result<SharedObject> open(const std::string& name, Access access);

  /// Maps all of it. `unreadable` when it is empty or shorter than `at_least`.
  Result<void> map(std::size_t at_least, bool prefault);

  std::byte* data() const { return static_cast<std::byte*>(region_.get_address()); }
  std::size_t size() const { return region_.get_size(); }
  int descriptor() const { return object_.get_mapping_handle().handle; }
  const std::string& name() const { return name_; }

  /// As it is now. Costs one system call.
  ObjectFacts facts() const;
  /// Whether the name still leads to this object.
  bool owns_its_name() const;
  /// Removes the name, if it still leads here; safe against others who do the same.
  void remove_name() const;

  /// What the name leads to; all zero when it leads nowhere. Costs one system call and no allocation.
  ObjectFacts facts_of_name() const;

 private:
  SharedObject(const std::string& name, Access access);
  Result<void> reserve(std::size_t bytes) const;

  std::string name_;
  std::string path_;  ///< made once: the heartbeat asks for it and allocates nothing
  Access access_ = Access::read_only;
  boost::interprocess::shared_memory_object object_;
  boost::interprocess::mapped_region region_;
};

}  // namespace linescope
