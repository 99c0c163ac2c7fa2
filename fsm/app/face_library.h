#pragma once

#include <string>
#include <vector>

#include "fsm/rig/head.h"
#include "vm_protocol/core/result.h"

namespace fsm {

/// The available faces, and the one shown. Thread: the module's.
class FaceLibrary {
 public:
  virtual ~FaceLibrary() = default;
  /// Returns the available faces, the initial one first; at least one.
  virtual std::vector<std::string> Faces() const = 0;
  /// Changes the face from the next drawing or Measure on. Errors: kBadValue listing the names,
  /// kUnavailable if it cannot be made; the face is then unchanged.
  virtual vm::Result<void> Select(const std::string& face) = 0;
  /// Returns the dimensions of the mouth in a state. Error: kUnavailable if the head cannot be
  /// made.
  virtual vm::Result<MouthMeasure> Measure(const FaceState& state) = 0;
};

}  // namespace fsm
