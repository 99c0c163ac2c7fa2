#pragma once

#include <string>

#include "vm_protocol/core/result.h"

namespace vm {

/// A descriptor, not blocking, of a connection to whoever listens at the Unix socket `path`; the
/// caller closes it. Error: kUnavailable with the system's reason.
Result<int> ConnectUnix(const std::string& path);

}  // namespace vm
