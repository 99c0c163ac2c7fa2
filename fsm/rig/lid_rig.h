#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "fsm/base/side.h"
#include "fsm/rig/eye_transform.h"
#include "fsm/rig/steps.h"

namespace fsm {

/// Lids that turn about the axes of the eyes.
struct LidRig {
  struct Vertex {
    std::uint32_t vertex = 0;
    Side side{};
    step::LidPoint at{};
    bool proper = false;  ///< of the lid itself, not of the fold behind it
  };
  std::vector<Vertex> vertices;
  Sided<EyeTransform> eyes;
  Sided<glm::vec3> ball;    ///< their centres
  float cornea_centre = 0;  ///< how far it lies before the ball's, millimetres
};

/// Lids that stay outside the eyeballs, whatever moves them.
struct BallLids {
  struct Vertex {
    std::uint32_t vertex;
    Side side;
    float least;  ///< distance from the ball's centre, millimetres
  };
  std::vector<Vertex> vertices;
  Sided<glm::vec3> centre;  ///< of the balls
};

}  // namespace fsm
