#include "vm_protocol/core/text_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>

#include "vm_protocol/core/file_kind.h"

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
  if (auto regular = CheckRegular(path, info, max_bytes); !regular) {
    return std::unexpected(std::move(regular.error()));
  }
  std::string text;
  std::array<char, 16384> buffer;
  while (true) {
    const ssize_t n = read(file.fd, buffer.data(), buffer.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return cannot(std::strerror(errno));
    if (n == 0) return text;
    text.append(buffer.data(), static_cast<std::size_t>(n));
    if (text.size() > max_bytes) {  // it grew, or has no size as those in /proc
      return std::unexpected(FileTooLong(path, max_bytes));
    }
  }
}

Result<void> WriteTextFile(const std::string& path, std::string_view text) {
  if (auto fit = CheckWritable(path); !fit) return fit;
  const bool to_null = path == "/dev/null";
  const std::string partial = to_null ? path : path + "." + std::to_string(getpid());
  std::ofstream file(partial, std::ios::binary);
  file << text;
  file.close();
  if (file && (to_null || std::rename(partial.c_str(), path.c_str()) == 0)) return {};
  if (!to_null) std::remove(partial.c_str());
  return Fail(Errc::kUnavailable, "cannot write '" + path + "'");
}

}  // namespace vm
