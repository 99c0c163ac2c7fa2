#pragma once

#include <string>
#include <string_view>
#include <utility>

#include "vm_protocol/core/result.h"

namespace vm {

/// A whole regular file; does not wait for anybody to write. Errors, which name the file:
/// kUnavailable with the system's reason, kAccess for pipes and devices, kTooLong over `max_bytes`
/// (of which no more is read).
Result<std::string> ReadTextFile(const std::string& path, std::size_t max_bytes);

/// A file under a name of its own beside another, whose place it takes once it is complete, so that
/// nobody reads half of one. Deleted with this until then. Errors: kUnavailable, of which the text
/// is the system's reason only.
class DraftFile {
 public:
  /// Makes it, empty.
  static Result<DraftFile> Beside(const std::string& path);
  DraftFile(DraftFile&& other) noexcept
      : path_(std::move(other.path_)), name_(std::exchange(other.name_, {})) {}
  ~DraftFile();
  /// Its own path; "" once it has taken its place.
  const std::string& name() const { return name_; }
  Result<void> TakePlace();

 private:
  DraftFile(std::string path, std::string name) : path_(std::move(path)), name_(std::move(name)) {}
  std::string path_, name_;
};

/// Puts a whole file, of bytes of any kind, in place of what is there, or leaves that as it is;
/// also while others read it. Errors, which name the file: those of CheckWritable, kUnavailable.
Result<void> WriteTextFile(const std::string& path, std::string_view text);

}  // namespace vm
