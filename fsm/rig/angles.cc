#include "fsm/rig/angles.h"

#include <algorithm>
#include <cmath>
#include <glm/trigonometric.hpp>

namespace fsm {

Angles HeadRotationOf(const glm::mat3& rotation) {
  return {glm::degrees(std::asin(std::clamp(-rotation[2][1], -1.0f, 1.0f))),
          glm::degrees(std::atan2(rotation[2][0], rotation[2][2])),
          glm::degrees(std::atan2(-rotation[0][1], rotation[1][1]))};
}

}  // namespace fsm
