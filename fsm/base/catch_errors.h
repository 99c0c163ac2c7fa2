#pragma once

#include <exception>
#include <string>
#include <type_traits>

#include "vm_protocol/core/result.h"

namespace fsm {

/// Returns what `act` returns, or kUnavailable with `doing` and the text of what it throws.
template <typename Act>
vm::Result<std::invoke_result_t<Act>> CatchErrors(const std::string& doing, const Act& act) try {
  if constexpr (std::is_void_v<std::invoke_result_t<Act>>) {
    act();
    return {};
  } else {
    return act();
  }
} catch (const std::exception& error) {
  return vm::Fail(vm::Errc::kUnavailable, doing + error.what());
}

}  // namespace fsm
