#include "fsm/rig/rig_data.h"

#include <utility>

namespace fsm {

RigData MakeStillRig(std::vector<glm::vec3> position, std::vector<glm::vec3> normal) {
  RigData rig;
  rig.bone.assign(position.size(), Bone::kSkull);
  rig.weights.resize(position.size());
  rig.rest = std::move(position);
  rig.rest_normal = std::move(normal);
  return rig;
}

}  // namespace fsm
