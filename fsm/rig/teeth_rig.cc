#include "fsm/rig/teeth_rig.h"

#include "fsm/base/smooth_step.h"
#include "fsm/rig/pose.h"
#include "fsm/rig/step_constants.h"

namespace fsm {

// Twin: STEP_teeth in fsm/render/shaders/rig_steps.glsl.
void KeepOffTeeth(const TeethRig& rig, const Pose& pose, std::span<glm::vec3> position) {
  // How much of a push counts, by height: all beside the crowns, fading past the edge.
  const auto beside = [](const ToothArch& arch, float y) {
    const float down = arch.root_y > arch.edge_y ? 1.0f : -1.0f;
    return SmoothStep(step::kPastTeeth, step::kBesideTeeth, down * (y - arch.edge_y));
  };
  for (const TeethRig::Contact& contact : rig.contacts) {
    glm::vec3& p = position[contact.vertex];
    const float upper = rig.upper.At(p.x) + contact.upper_gap - p.z;
    if (upper > 0) p.z += upper * beside(rig.upper, p.y);
    glm::vec3 q = IntoJaw(p, pose);
    const float lower = rig.lower.At(q.x) + contact.lower_gap - q.z;
    if (lower > 0) {
      q.z += lower * beside(rig.lower, q.y);
      p = TurnJaw(q, pose, 1);
    }
  }
}

}  // namespace fsm
