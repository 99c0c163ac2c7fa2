#pragma once

#include <string>

#include "vm_protocol/core/result.h"

namespace vm {

/// A whole regular file. Errors: kUnavailable if it cannot be read (with the system's reason) or is
/// a pipe, a device or a folder; kTooLong if it is over `max_bytes`, of which no more is read. Both
/// name the file. Does not wait for anybody to write.
Result<std::string> ReadTextFile(const std::string& path, std::size_t max_bytes);

}  // namespace vm
