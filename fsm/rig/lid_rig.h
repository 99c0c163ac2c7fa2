#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "fsm/base/side.h"
#include "fsm/rig/eye_transform.h"
#include "fsm/rig/steps.h"

namespace fsm {

/// Lids that rotate about the transverse axes of the eyes.
struct LidRig {
  struct Vertex {
    std::uint32_t vertex = 0;
    Side side{};
    step::LidPoint at{};
    bool proper = false;  ///< true for the lid itself, false for the fold behind it
  };
  std::vector<Vertex> vertices;
  Sided<EyeTransform> eyes;
  Sided<glm::vec3> ball;    ///< centres of the eyeballs
  float cornea_centre = 0;  ///< from the ball's centre to the cornea's, millimetres
};

/// Lids that are kept outside the eyeballs, whatever moves them.
struct BallLids {
  struct Vertex {
    std::uint32_t vertex;
    Side side;
    float least;  ///< least distance from the ball's centre, millimetres
  };
  std::vector<Vertex> vertices;
  Sided<glm::vec3> centre;  ///< of the eyeballs
};

}  // namespace fsm
