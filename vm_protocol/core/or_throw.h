#pragma once

#include <stdexcept>
#include <type_traits>
#include <utility>

#include "vm_protocol/core/result.h"

namespace vm {

/// For what the world refuses at start-up: the value, or std::runtime_error with the error's text.
template <typename T>
T OrThrow(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().text);
  if constexpr (!std::is_void_v<T>) return std::move(*result);
}

}  // namespace vm
