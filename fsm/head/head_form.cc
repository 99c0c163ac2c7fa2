#include "fsm/head/head_form.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "fsm/base/smooth_step.h"

namespace fsm {

HeadForm::HeadForm(const EyeAnatomy& eye, const MouthAnatomy& mouth, const SliderWarp& sliders,
                   const Warp* warp, const std::optional<Sided<EyeTransform>>& eye_transforms,
                   const MeshBuilder& base, const EyeTransform& left_eye)
    : eye_(eye), mouth_(mouth), sliders_(sliders), warp_(warp) {
  if (eye_transforms) {
    eye_transforms_ = *eye_transforms;
  } else {
    constexpr glm::vec3 kMirror(-1, 1, 1);
    const glm::vec3 by = 0.5f * (Motion(eye_.centre()) + kMirror * Motion(eye_.centre() * kMirror));
    // A larger ball lies deeper, so that its front stays in place.
    const glm::vec3 deeper(0, 0, (1 - left_eye.size) * eye_.radius());
    eye_transforms_ = {left_eye, left_eye};
    eye_transforms_.left.shift = by + deeper;
    eye_transforms_.right.shift = by * kMirror + deeper;
    eye_transforms_.right.roll = -left_eye.roll;
  }
  const auto lips = [&](float x) {
    return Motion({x, mouth_.LineY(std::abs(x)), mouth_.LineZ(std::abs(x))});
  };
  teeth_.shift = lips(0) * (warp_ ? glm::vec3(0, 1, 1) : glm::vec3(0, 0.5f, 0.5f));
  if (warp_) {
    // A person's mouth may be off the median and turned to one side.
    constexpr float kAside = 18, kSteepest = 0.35f;
    const glm::vec3 left = lips(kAside), right = lips(-kAside);
    teeth_.shift.x = 0.5f * (left.x + right.x);
    teeth_.slope = std::clamp((left.z - right.z) / (2 * kAside), -kSteepest, kSteepest);
    // Parted lips show the upper teeth: more than 3 mm in women, 2 mm in men (Vig and Brundo 1978).
    teeth_.shift.y -= 1.0f;
    teeth_.shift.z -= TeethTooFar(base);
  }
}

glm::vec3 HeadForm::Motion(glm::vec3 p) const {
  const glm::vec3 by = sliders_.Motion(p);
  return warp_ ? by + warp_->Motion(p + by) : by;
}

float HeadForm::TeethTooFar(const MeshBuilder& base) const {
  constexpr float kRoom = 1.3f, kMax = 8;
  float most = 0;
  for (const ToothArch& arch : {mouth_.upper_teeth(), mouth_.lower_teeth()}) {
    for (std::size_t i = 0; i < base.position.size(); ++i) {
      if (base.bone[i] != Bone::kSkin || !base.weights[i].by_teeth) continue;
      const glm::vec3 p = base.position[i], q = p + Motion(p);
      const float room = std::min(kRoom, p.z - step::ArchZ(arch, p.x));
      most = std::max(most, room - (q.z - step::ArchZ(Moved(arch, teeth_), q.x)));
    }
  }
  return std::min(most, kMax);
}

void HeadForm::Shape(MeshBuilder& mesh) const {
  using Follows = BakeWeights::Follows;
  for (std::size_t i = 0; i < mesh.position.size(); ++i) {
    const BakeWeights& weights = mesh.weights[i];
    if (weights.follows == Follows::kNothing) continue;
    glm::vec3& p = mesh.position[i];
    switch (mesh.bone[i]) {
      case Bone::kEyeLeft:
      case Bone::kEyeRight:
        p = EyePointInFace(eye_, eye_transforms_, *SideOfEye(mesh.bone[i]), p);
        break;
      case Bone::kJaw:
      case Bone::kTongue:
        p = teeth_(p);
        break;
      case Bone::kSkull:
        p = weights.follows == Follows::kTeeth ? teeth_(p) : p + Motion(p);
        break;
      case Bone::kSkin: {
        glm::vec3 by = Motion(p);
        if (weights.eye) {
          const float hold = SmoothStep(0, 0.8f, weights.lid_upper + weights.lid_lower);
          by = glm::mix(by, EyePointInFace(eye_, eye_transforms_, *weights.eye, p) - p, hold);
        }
        p += by;
        break;
      }
    }
  }
}

glm::vec3 EyePointInFace(const EyeAnatomy& eye, const Sided<EyeTransform>& eye_transforms,
                         Side side, glm::vec3 p) {
  return eye_transforms[side].PointInFace(eye.CentreOf(side), p);
}

}  // namespace fsm
