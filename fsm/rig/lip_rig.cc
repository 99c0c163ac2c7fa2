#include "fsm/rig/lip_rig.h"

#include <algorithm>

namespace fsm {

// Twins: STEP_lip_gaps and STEP_lips in fsm/render/shaders/rig_steps.glsl.
void CloseLips(const LipRig& rig, float seal, std::span<glm::vec3> position) {
  thread_local std::vector<glm::vec3> correction;  // kept from frame to frame
  correction.clear();
  for (std::size_t k = 0; k < rig.seam.size(); ++k) {
    glm::vec3 apart = position[rig.seam[k].first] - position[rig.seam[k].second];
    if (!rig.apart_at_rest.empty()) apart -= rig.apart_at_rest[k];
    glm::vec3 by = seal * apart;
    by.y += (1 - seal) * std::min(apart.y, 0.0f);
    correction.push_back(by);
  }
  for (const LipRig::Follower& f : rig.followers) {
    position[f.vertex] -= LipRig::ShareOf(f) * correction[f.pair];
  }
}

}  // namespace fsm
