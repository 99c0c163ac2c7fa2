#pragma once

#include <utility>
#include <vector>

#include "fsm/rig/rig_data.h"

namespace support {

/// Returns a rig whose vertices never move.
inline fsm::RigData MakeStillRig(std::vector<glm::vec3> position, std::vector<glm::vec3> normal) {
  fsm::RigData rig;
  rig.bone.assign(position.size(), fsm::Bone::kSkull);
  rig.weights.resize(position.size());
  rig.rest = std::move(position);
  rig.rest_normal = std::move(normal);
  return rig;
}

}  // namespace support
