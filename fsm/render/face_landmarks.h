#pragma once

#include <glm/vec3.hpp>
#include <optional>

#include "fsm/rig/head.h"

namespace fsm {

/// Where things are on a face, from the head's landmarks; millimetres at rest.
struct FaceLandmarks {
  glm::vec3 nasion, pronasale, subnasale, stomion, gnathion, trichion;
  Sided<glm::vec3> cheilion, endocanthion, exocanthion, pupil, alare, zygion;

  /// Nothing for a head that does not name all of them.
  static std::optional<FaceLandmarks> Of(const Head& head);
};

}  // namespace fsm
