#include "vm_protocol/core/file_kind.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace vm {
namespace {

std::unexpected<Error> Cannot(const char* verb, const std::string& path, int why) {
  return Fail(Errc::kUnavailable,
              std::string("cannot ") + verb + " '" + path + "': " + std::strerror(why));
}

std::unexpected<Error> NotRegular(const std::string& path) {
  return Fail(Errc::kAccess, "'" + path + "' is not a regular file");
}

bool IsNull(const struct stat& state) {
  struct stat null {};
  return S_ISCHR(state.st_mode) && stat("/dev/null", &null) == 0 && state.st_rdev == null.st_rdev;
}

}  // namespace

Error FileTooLong(const std::string& path, std::size_t max_bytes) {
  return {Errc::kTooLong, "file '" + path + "' is over " + std::to_string(max_bytes) + " bytes"};
}

Result<void> CheckRegular(const std::string& path, const struct stat& state,
                          std::size_t max_bytes) {
  if (S_ISDIR(state.st_mode)) return Cannot("read", path, EISDIR);
  if (!S_ISREG(state.st_mode)) return NotRegular(path);
  if (state.st_size > 0 && static_cast<std::size_t>(state.st_size) > max_bytes) {
    return std::unexpected(FileTooLong(path, max_bytes));
  }
  return {};
}

Result<void> CheckReadable(const std::string& path, std::size_t max_bytes) {
  struct stat state {};
  if (stat(path.c_str(), &state) != 0) return Cannot("read", path, errno);
  return CheckRegular(path, state, max_bytes);
}

std::string RemovePart(const std::string& path) {
  struct stat state {};
  if (stat(path.c_str(), &state) != 0 || !S_ISREG(state.st_mode)) return "";
  return unlink(path.c_str()) == 0 ? "; the part that was written is removed"
                                   : "; a part of it was written and cannot be removed";
}

Result<void> CheckWritable(const std::string& path) {
  struct stat state {};
  if (stat(path.c_str(), &state) != 0) {
    if (errno == ENOENT) return {};
    return Cannot("write", path, errno);
  }
  if (S_ISDIR(state.st_mode)) return Cannot("write", path, EISDIR);
  if (S_ISREG(state.st_mode) || IsNull(state)) return {};
  return NotRegular(path);
}

}  // namespace vm
