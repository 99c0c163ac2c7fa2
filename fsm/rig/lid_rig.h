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
    step::LidPlace point{};
    bool is_lid = false;  ///< true for the lid itself, false for the fold behind it
  };
  std::vector<Vertex> vertices;
  Sided<EyeTransform> eyes;
  /// Centres of the eyeballs on the head the lids were made for (ProxyForm).
  Sided<glm::vec3> ball;
  float cornea_centre = 0;  ///< from the ball's centre to the cornea's, millimetres
};

/// A vertex of a lid that is kept outside the eyeball, whatever moves it.
struct BallLid {
  std::uint32_t vertex;
  Side side;
  float min_radius;  ///< distance from the ball's centre, millimetres
};

}  // namespace fsm
