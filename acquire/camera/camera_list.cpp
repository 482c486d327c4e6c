#include "acquire/camera/camera_list.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/videodev2.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include "acquire/camera/natural_order.hpp"

namespace linescope {
namespace {

namespace fs = std::filesystem;

class Descriptor {
 public:
  explicit Descriptor(const std::string& path) : fd_(::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC)) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return fd_; }

 private:
  int fd_;
};

/// 0, or the error number of asking for `count` buffers.
int request_buffers(int fd, std::uint32_t type, std::uint32_t count) {
  v4l2_requestbuffers request{};
  request.count = count;
  request.type = type;
  request.memory = V4L2_MEMORY_MMAP;
  return ::ioctl(fd, VIDIOC_REQBUFS, &request) == 0 ? 0 : errno;
}

std::string obstacle_of_capture(const std::string& path, int fd, std::uint32_t capabilities) {
  const std::uint32_t type = (capabilities & V4L2_CAP_VIDEO_CAPTURE) != 0
                                 ? V4L2_BUF_TYPE_VIDEO_CAPTURE
                                 : V4L2_BUF_TYPE_VIDEO_CAPTURE_MPLANE;
  const int error = request_buffers(fd, type, 1);
  if (error == EBUSY) return obstacle_from_errno(path, error);
  if (error == 0) request_buffers(fd, type, 0);
  return {};
}

std::string obstacle_of(const std::string& path) {
  const Descriptor node(path);
  if (node.get() < 0) return obstacle_from_errno(path, errno);
  v4l2_capability capability{};
  if (::ioctl(node.get(), VIDIOC_QUERYCAP, &capability) != 0) return obstacle_from_errno(path, errno);
  const bool own = (capability.capabilities & V4L2_CAP_DEVICE_CAPS) != 0;
  const std::uint32_t can = own ? capability.device_caps : capability.capabilities;
  if ((can & (V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_VIDEO_CAPTURE_MPLANE)) == 0) {
    return fmt::format("{} gives no pictures (a camera's node for metadata or output); use its other node",
                       path);
  }
  return obstacle_of_capture(path, node.get(), can);
}

std::string first_line(const fs::path& file) {
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  return line;
}

std::string path_from_choice(const std::string& choice) {
  const bool index = !choice.empty() && choice.find_first_not_of("0123456789") == std::string::npos;
  return index ? "/dev/video" + choice : choice;
}

ErrorCode code_of(const CameraInfo& camera) {
  if (camera.obstacle.find("another program") != std::string::npos) return ErrorCode::busy;
  if (camera.obstacle.find("permission") != std::string::npos) return ErrorCode::permission;
  return ErrorCode::unsupported;
}

std::string what_there_is(const std::vector<CameraInfo>& cameras) {
  if (cameras.empty())
    return "no camera is connected; plug one in, or name a folder of pictures or a video file";
  std::string text = "there is";
  for (const CameraInfo& camera : cameras) {
    text += fmt::format("{} {} ({}{})", &camera == cameras.data() ? "" : ",", camera.path, camera.name,
                        camera.usable() ? "" : ", not usable");
  }
  return text;
}

}  // namespace

std::string obstacle_from_errno(const std::string& path, int error) {
  switch (error) {
    case EACCES:
    case EPERM:
      return fmt::format("no permission to open {}; add the user to the group video and log in again", path);
    case EBUSY:
      return fmt::format("{} is in use by another program; close it (fuser {} names it)", path, path);
    case ENOENT:
    case ENODEV:
    case ENXIO:
      return fmt::format("{} was unplugged or has no driver; plug the camera in again", path);
    case ENOTTY:
    case EINVAL:
      return fmt::format("{} is not a camera", path);
    default:
      return fmt::format("{} cannot be opened: {}", path, std::strerror(error));
  }
}

std::vector<CameraInfo> list_cameras(const fs::path& sysfs, const fs::path& dev) {
  std::vector<CameraInfo> cameras;
  std::error_code error;
  for (fs::directory_iterator entry(sysfs, error), end; !error && entry != end; entry.increment(error)) {
    const std::string node = entry->path().filename().string();
    if (node.rfind("video", 0) != 0) continue;
    const std::string path = (dev / node).string();
    cameras.push_back({path, first_line(entry->path() / "name"), obstacle_of(path)});
  }
  std::sort(cameras.begin(), cameras.end(),
            [](const CameraInfo& a, const CameraInfo& b) { return natural_less(a.path, b.path); });
  return cameras;
}

Result<CameraInfo> choose_camera(const std::string& choice, const std::vector<CameraInfo>& cameras) {
  const std::string path = path_from_choice(choice);
  const CameraInfo* blocked = nullptr;
  for (const CameraInfo& camera : cameras) {
    const bool meant = choice.empty() || camera.path == path || camera.name.find(choice) != std::string::npos;
    if (meant && camera.usable()) return camera;
    if (meant && blocked == nullptr) blocked = &camera;
  }
  if (blocked != nullptr) return fail(code_of(*blocked), blocked->obstacle);
  if (choice.empty()) return fail(ErrorCode::not_found, what_there_is(cameras));
  return fail(ErrorCode::not_found, fmt::format("there is no camera {}; {}", choice, what_there_is(cameras)));
}

}  // namespace linescope
