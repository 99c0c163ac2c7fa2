#pragma once

#include <cstddef>
#include <limits>
#include <string>

#include "vm_protocol/core/result.h"

struct stat;

namespace vm {

/// Asked before a file is opened that a line of the protocol names, by itself or through another
/// file: opening a named pipe waits for its other end, and a device need never end. Nothing is
/// opened or made. Errors, which name the file: kUnavailable with the system's reason (folders
/// included), kAccess for pipes, sockets and devices, kTooLong over `max_bytes`.

/// It must be a regular file. Whether it may be read shows when it is opened.
Result<void> CheckReadable(const std::string& path,
                           std::size_t max_bytes = std::numeric_limits<std::size_t>::max());

/// It must be a regular file, /dev/null, or not there yet.
Result<void> CheckWritable(const std::string& path);

/// Removes what was written of a file that could not be finished, as on a full disk; never what is
/// no regular file. Returns the end of the error's text, which says what became of it.
std::string RemovePart(const std::string& path);

/// CheckReadable of a file whose state is known; and its last error.
Result<void> CheckRegular(const std::string& path, const struct stat& state, std::size_t max_bytes);
Error FileTooLong(const std::string& path, std::size_t max_bytes);

}  // namespace vm
