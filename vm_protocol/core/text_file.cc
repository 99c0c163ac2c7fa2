#include "vm_protocol/core/text_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

namespace vm {
namespace {

struct Descriptor {
  int fd = -1;
  ~Descriptor() {
    if (fd >= 0) close(fd);
  }
};

}  // namespace

Result<std::string> ReadTextFile(const std::string& path, std::size_t max_bytes) {
  const auto cannot = [&path](const char* why) {
    return Fail(Errc::kUnavailable, "cannot read '" + path + "': " + why);
  };
  // Without O_NONBLOCK opening a named pipe waits for somebody to write into it.
  const Descriptor file{open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY)};
  if (file.fd < 0) return cannot(std::strerror(errno));
  struct stat info {};
  if (fstat(file.fd, &info) != 0) return cannot(std::strerror(errno));
  if (S_ISDIR(info.st_mode)) return cannot(std::strerror(EISDIR));
  if (!S_ISREG(info.st_mode)) return Fail(Errc::kAccess, "'" + path + "' is not a regular file");
  const auto over = [&] {
    return Fail(Errc::kTooLong,
                "file '" + path + "' is over " + std::to_string(max_bytes) + " bytes");
  };
  if (info.st_size > 0 && static_cast<std::size_t>(info.st_size) > max_bytes) return over();
  std::string text;
  std::array<char, 16384> buffer;
  while (true) {
    const ssize_t n = read(file.fd, buffer.data(), buffer.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return cannot(std::strerror(errno));
    if (n == 0) return text;
    text.append(buffer.data(), static_cast<std::size_t>(n));
    if (text.size() > max_bytes) return over();  // it grew, or has no size as those in /proc
  }
}

}  // namespace vm
