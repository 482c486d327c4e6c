#include "acquire/tracker/liberty/serial_transport.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <ctime>

namespace linescope {
namespace {

speed_t speed_for(int baud) {
  switch (baud) {
    case 38400:
      return B38400;
    case 57600:
      return B57600;
    default:
      return B115200;
  }
}

int milliseconds_for(Nanoseconds t) {
  return static_cast<int>((t + kMillisecond - 1) / kMillisecond);
}

/// True when the descriptor is ready in time; interruptions by signals do not shorten the wait noticeably.
bool ready(int fd, short events, Nanoseconds at_most) {
  pollfd p{fd, events, 0};
  return ::poll(&p, 1, milliseconds_for(at_most)) > 0;
}

}  // namespace

Result<void> SerialTransport::open() {
  close();
  fd_ = ::open(device_.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (fd_ < 0) return cannot_open(errno);
  auto taken = take_exclusively();
  if (taken) taken = set_line();
  if (!taken) close();
  return taken;
}

void SerialTransport::close() {
  if (fd_ < 0) return;
  ::ioctl(fd_, TIOCNXCL);
  ::close(fd_);
  fd_ = -1;
}

tl::unexpected<Error> SerialTransport::cannot_open(int error) const {
  if (error == ENOENT || error == ENXIO || error == ENODEV)
    return fail(ErrorCode::not_found,
                fmt::format("LIBERTY: there is no serial device {}; check its cable and name", device_));
  if (error == EACCES || error == EPERM)
    return fail(ErrorCode::permission,
                fmt::format("LIBERTY: no permission to open {}; add the user to the group "
                            "dialout and log in again",
                            device_));
  if (error == EBUSY)
    return fail(ErrorCode::busy,
                fmt::format("LIBERTY: {} is in use by another program; end that one first", device_));
  return fail(ErrorCode::unreadable,
              fmt::format("LIBERTY: {} cannot be opened: {}", device_, std::strerror(error)));
}

/// The lock keeps well-behaved programs out, also those of root; TIOCEXCL keeps out all others.
Result<void> SerialTransport::take_exclusively() {
  if (::flock(fd_, LOCK_EX | LOCK_NB) != 0) return cannot_open(EBUSY);
  ::ioctl(fd_, TIOCEXCL);
  return {};
}

Result<void> SerialTransport::set_line() {
  termios line{};
  if (::tcgetattr(fd_, &line) != 0)
    return fail(ErrorCode::unreadable, fmt::format("LIBERTY: {} is not a serial line", device_));
  ::cfmakeraw(&line);
  line.c_cflag |= CLOCAL | CREAD;
  line.c_cflag &= ~static_cast<tcflag_t>(CRTSCTS | PARENB | CSTOPB);
  ::cfsetspeed(&line, speed_for(baud_));
  if (::tcsetattr(fd_, TCSANOW, &line) != 0)
    return fail(ErrorCode::unsupported, fmt::format("LIBERTY: {} cannot be set to {} baud", device_, baud_));
  ::tcflush(fd_, TCIOFLUSH);
  return {};
}

tl::unexpected<Error> SerialTransport::gone() const {
  return fail(ErrorCode::gone,
              fmt::format("LIBERTY: the serial device {} is gone; plug it in again", device_));
}

Result<void> SerialTransport::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(fd_, bytes.data(), bytes.size());
    if (n > 0)
      bytes.remove_prefix(static_cast<std::size_t>(n));
    else if (n < 0 && errno == EINTR)
      continue;
    else if (n < 0 && errno != EAGAIN)
      return gone();
    else if (!ready(fd_, POLLOUT, kSecond))
      return fail(ErrorCode::timeout,
                  fmt::format("LIBERTY: {} takes no more bytes; {}", device_, silence_hint()));
  }
  return {};
}

Result<Chunk> SerialTransport::read(Nanoseconds at_most) {
  if (!ready(fd_, POLLIN, at_most)) return Chunk{};
  const ssize_t n = ::read(fd_, buffer_.data(), buffer_.size());
  if (n > 0) return Chunk{{buffer_.data(), static_cast<std::size_t>(n)}, monotonic_now()};
  if (n < 0 && (errno == EAGAIN || errno == EINTR)) return Chunk{};
  return gone();
}

void SerialTransport::wait_for_change(Nanoseconds at_most) {
  const timespec wait{at_most / kSecond, at_most % kSecond};
  ::nanosleep(&wait, nullptr);
}

std::string SerialTransport::description() const {
  return fmt::format("{} at {} baud", device_, baud_);
}

std::string SerialTransport::silence_hint() const {
  return fmt::format(
      "check that it is switched on, set to {} baud 8N1 and wired with a null-modem cable; if its USB "
      "cable is or was plugged in, unplug that and switch the unit off and on",
      baud_);
}

}  // namespace linescope
