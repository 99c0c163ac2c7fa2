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

Result<DraftFile> DraftFile::Beside(const std::string& path) {
  constexpr int kMaxDrafts = 1000;  // limit of files left by killed programs
  for (int number = 1;; ++number) {
    std::string name = path + "." + std::to_string(number) + ".part";
    const Descriptor file{open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666)};
    if (file.fd >= 0) return DraftFile(path, std::move(name));
    if (errno != EEXIST || number == kMaxDrafts) {
      return Fail(Errc::kUnavailable, std::strerror(errno));
    }
  }
}

DraftFile::~DraftFile() {
  if (!name_.empty()) std::remove(name_.c_str());
}

Result<void> DraftFile::TakePlace() {
  if (std::rename(name_.c_str(), path_.c_str()) != 0) {
    return Fail(Errc::kUnavailable, std::strerror(errno));
  }
  name_.clear();
  return {};
}

Result<void> WriteTextFile(const std::string& path, std::string_view text) {
  if (auto fit = CheckWritable(path); !fit || path == "/dev/null") return fit;
  const auto cannot = [&path](const std::string& why) {
    return Fail(Errc::kUnavailable, "cannot write '" + path + "': " + why);
  };
  auto draft = DraftFile::Beside(path);
  if (!draft) return cannot(draft.error().text);
  std::ofstream file(draft->name(), std::ios::binary);
  file << text;
  file.close();
  if (!file) return cannot(std::strerror(errno));
  if (auto placed = draft->TakePlace(); !placed) return cannot(placed.error().text);
  return {};
}

}  // namespace vm
