#pragma once

#include <glm/vec3.hpp>
#include <memory>
#include <span>

#include "fsm/rig/face_state.h"

namespace fsm {

struct Pose;
class UnitTable;

/// What the lower jaw does: about the hinge, forward and to the viewer's right.
struct JawMove {
  float open_rad = 0, slide_mm = 0, sway_mm = 0;
};

/// How the skin of a head follows a state where channels alone do not say it. Immutable; thread:
/// any.
class Deformation {
 public:
  virtual ~Deformation() = default;
  /// `position`: of all vertices, at rest on entry; those of skin are moved, the head's turn apart.
  /// Returns what the jaw, and what is fixed to it, does.
  virtual JawMove Move(const FaceState& state, const Pose& pose,
                       std::span<glm::vec3> position) const = 0;
  /// The same, where units move as another table says; nothing if that changes nothing here.
  virtual std::unique_ptr<Deformation> WithUnits(const UnitTable& /*units*/) const {
    return nullptr;
  }
};

}  // namespace fsm
