#pragma once

#include <string>
#include <string_view>

#include "vm_protocol/core/result.h"

namespace vm {

/// A whole regular file; does not wait for anybody to write. Errors, which name the file:
/// kUnavailable with the system's reason, kAccess for pipes and devices, kTooLong over `max_bytes`
/// (of which no more is read).
Result<std::string> ReadTextFile(const std::string& path, std::size_t max_bytes);

/// Puts a whole file in place of what is there, or leaves that as it is; also while others read it.
/// Errors, which name the file: those of CheckWritable, kUnavailable.
Result<void> WriteTextFile(const std::string& path, std::string_view text);

}  // namespace vm
