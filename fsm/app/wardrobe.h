#pragma once

#include <string>
#include <vector>

#include "fsm/rig/head.h"
#include "vm_protocol/core/result.h"

namespace fsm {

/// The faces there are, and the one that is worn. Thread: the module's.
class Wardrobe {
 public:
  virtual ~Wardrobe() = default;
  /// The faces there are, the one worn at the start first; at least one.
  virtual std::vector<std::string> Faces() const = 0;
  /// Wears one of them from the next drawing or Measure on. Errors: kBadValue listing the names,
  /// kUnavailable if it cannot be made; the face worn stays on.
  virtual vm::Result<void> Wear(const std::string& face) = 0;
  /// What the mouth of a state measures. Error: kUnavailable if the head cannot be made.
  virtual vm::Result<MouthMeasure> Measure(const FaceState& state) = 0;
};

}  // namespace fsm
