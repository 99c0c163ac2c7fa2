#pragma once

#include <stdexcept>
#include <type_traits>
#include <utility>

#include "vm_protocol/core/result.h"

namespace vm {

/// An error on its way to somebody who hands it on or prints its text.
struct Failure : std::runtime_error {
  explicit Failure(Error of) : std::runtime_error(of.text), error(std::move(of)) {}
  Error error;
};

/// The value, or Failure: for what the world refuses at start-up, and within a reader.
template <typename T>
T OrThrow(Result<T> result) {
  if (!result) throw Failure(std::move(result.error()));
  if constexpr (!std::is_void_v<T>) return std::move(*result);
}

}  // namespace vm
