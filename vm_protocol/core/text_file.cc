#include "vm_protocol/core/text_file.h"

#include <cerrno>
#include <cstring>
#include <fstream>

namespace vm {

Result<std::string> ReadTextFile(const std::string& path, std::size_t max_bytes) {
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  std::string text;
  char buffer[4096];
  while (file.read(buffer, sizeof(buffer)) || file.gcount() > 0) {
    text.append(buffer, static_cast<std::size_t>(file.gcount()));
    if (text.size() > max_bytes) {
      return Fail(Errc::kTooLong,
                  "file '" + path + "' is over " + std::to_string(max_bytes) + " bytes");
    }
  }
  if (!file.is_open() || file.bad()) {
    return Fail(Errc::kUnavailable, "cannot read '" + path + "': " + std::strerror(errno));
  }
  return text;
}

}  // namespace vm
