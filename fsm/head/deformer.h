#pragma once

#include <array>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <utility>
#include <vector>

#include "fsm/head/action_units.h"
#include "fsm/head/anatomy.h"
#include "fsm/head/eye_transform.h"
#include "fsm/head/face_state.h"
#include "fsm/head/rig.h"

namespace fsm {

/// The numbers of one state from which every vertex follows.
struct Pose {
  SidedUnits units;
  std::array<float, kMouthParameters> mouth;
  std::array<UnitEffects::Lids, 2> lids;  ///< right, left; gaze and blink included
  float jaw_rad = 0, jaw_slide_mm = 0, jaw_sway_mm = 0;
  float jaw_cos = 1, jaw_sin = 0;  // of jaw_rad
  float seal = 0;
  float tongue_raise = 0, tongue_out_mm = 0;
  std::array<glm::mat3, 2> eye;  ///< right, left
  glm::mat3 head;
  float head_forward_mm = 0;
};
/// Clamps `state` to what anatomy allows; anything not a number counts as 0.
Pose MakePose(const FaceState& state, const UnitTable& units);

/// The hinge of the jaw: an axis along x.
inline constexpr float kHingeY = -4.0f;
inline constexpr float kHingeZ = -3.0f;
/// The point the head turns about, in the upper neck.
inline constexpr glm::vec3 kNeckPivot{0, -85, -28};

glm::vec3 TurnJaw(glm::vec3 p, const Pose& pose, float weight);
/// Where a point would lie in the jaw at rest.
glm::vec3 IntoJaw(glm::vec3 p, const Pose& pose);
glm::vec3 TurnHead(glm::vec3 p, const Pose& pose, float weight);

/// Moves flesh. Made once for the whole face and once for the few vertices by which the mouth is
/// measured, so that both give the same numbers. Immutable; thread: any.
class Deformer {
 public:
  /// `seam` pairs index the arrays given. `seats`: of the right and the left eye; `teeth`:
  /// from where `mouth` has them. SkinWeights::lip_column indexes `seam`.
  Deformer(std::vector<glm::vec3> rest, std::vector<SkinWeights> flesh,
           std::vector<std::pair<std::uint32_t, std::uint32_t>> seam, const UnitTable& units,
           const EyeAnatomy& eye, const std::array<EyeTransform, 2>& seats,
           const MouthAnatomy& mouth, const TeethPlace& teeth);

  std::size_t size() const { return rest_.size(); }
  /// Takes the fields of other units.
  void MoveBy(const UnitTable& units);
  /// Writes size() positions, the head's turn not yet applied.
  void Deform(const Pose& pose, glm::vec3* out) const;
  float neck(std::size_t i) const { return flesh_[i].neck; }

 private:
  struct Delta {
    std::uint32_t vertex;
    glm::vec3 by;
  };
  struct LidVertex {
    std::uint32_t vertex;
    int side;            // 0 right, 1 left
    float upper, lower;  // part in each lid's turn
    float upper_angle, lower_angle, meet_angle, opening;
    float y, z;  // at rest from the axis of the lids, in the table's eye
  };
  void AddMouthFields(const MouthAnatomy& mouth);
  void AddLids(const EyeAnatomy& eye);
  void MoveLids(const Pose& pose, glm::vec3* out) const;
  void KeepOffTeeth(const Pose& pose, glm::vec3* out) const;
  void CloseLips(const Pose& pose, glm::vec3* out) const;

  std::vector<glm::vec3> rest_;
  std::vector<SkinWeights> flesh_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> seam_;
  std::array<std::array<std::vector<Delta>, kActionUnits>, 2> unit_fields_;
  std::array<std::vector<Delta>, kMouthParameters> mouth_fields_;
  std::array<EyeTransform, 2> seats_;
  std::array<glm::vec3, 2> ball_{};  ///< centres, right and left
  float cornea_ = 0;                 ///< how far its centre lies before the ball's
  std::vector<LidVertex> lids_;
  std::vector<std::uint32_t> jawed_, lipped_;
  struct Touching {
    std::uint32_t vertex;
    float upper_gap, lower_gap;  // least distances from either arch, by the distance at rest
  };
  ToothArch upper_teeth_{}, lower_teeth_{};
  std::vector<Touching> touching_;
};

}  // namespace fsm
