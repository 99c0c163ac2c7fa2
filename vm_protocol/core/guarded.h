#pragma once

#include <exception>
#include <utility>

#include "vm_protocol/core/result.h"

namespace vm {

/// Calls `act` at a root, where nobody is left to catch: the loop, a thread, a C library's
/// callback. Errors: kInternal, with the text of what it has thrown.
template <typename Act>
Result<void> Guarded(Act&& act) {
  try {
    std::forward<Act>(act)();
    return {};
  } catch (const std::exception& error) {
    return Fail(Errc::kInternal, error.what());
  } catch (...) {
    return Fail(Errc::kInternal, "something that is no std::exception was thrown");
  }
}

}  // namespace vm
