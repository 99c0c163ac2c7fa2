#pragma once

#include <glm/vec3.hpp>
#include <optional>

#include "fsm/rig/head.h"

namespace fsm {

/// Positions of the features of a face, from the head's landmarks; millimetres at rest.
struct FaceLandmarks {
  glm::vec3 nasion, pronasale, subnasale, stomion, gnathion, trichion;
  Sided<glm::vec3> cheilion, endocanthion, exocanthion, pupil, alare, zygion;

  /// Returns nothing for a head that lacks one of them.
  static std::optional<FaceLandmarks> Find(const Head& head);
};

}  // namespace fsm
