#include "fsm/rig/lid_rig.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "fsm/rig/pose.h"
#include "fsm/rig/step_constants.h"

namespace fsm {
namespace {

// Twins: STEP_lids and STEP_lids_on_balls in fsm/render/shaders/rig_steps.glsl.

/// The angle by which a vertex turns about the axis of the lids.
float TurnOf(const LidRig::Vertex& lid, const EyeTransform& eye, const UnitEffects::Lids& ask) {
  float upper = lid.upper_angle + lid.opening * (eye.upper_mm + ask.upper_mm) / step::kLidRadius;
  // A lower lid that is raised goes up nearly as far beside the middle, so that it stays a curve.
  const float raised = ask.lower_mm * (ask.lower_mm > 0 ? std::sqrt(lid.opening) : lid.opening);
  float lower = lid.lower_angle + (lid.opening * eye.lower_mm + raised) / step::kLidRadius;
  if (upper < lower) upper = lower = 0.5f * (upper + lower);
  upper += ask.close * (lid.meet_angle - upper);
  lower += ask.close * (lid.meet_angle - lower);
  return lid.upper * (upper - lid.upper_angle) + lid.lower * (lower - lid.lower_angle);
}

}  // namespace

void MoveLids(const LidRig& rig, const Pose& pose, std::span<glm::vec3> position) {
  for (const LidRig::Vertex& lid : rig.vertices) {
    const EyeTransform& eye = rig.eyes[lid.side];
    glm::vec3& p = position[lid.vertex];
    if (const float turn = TurnOf(lid, eye, pose.lids[lid.side]); turn != 0) {
      const float c = std::cos(turn);
      const float s = std::sin(turn);
      p += eye.Turned({0, lid.y * c + lid.z * s - lid.y, lid.z * c - lid.y * s - lid.z});
    }
    if (!lid.proper) continue;
    // The cornea bulges the lid it rolls under.
    const glm::vec3 middle =
        rig.ball[lid.side] + eye.size * rig.cornea_centre * pose.eye[lid.side][2];
    const glm::vec3 off = p - middle;
    const float distance = glm::length(off);
    const float least = eye.size * (kCorneaRadius + step::kLidThickness);
    if (distance < least && distance > 1) p = middle + off * (least / distance);
  }
}

void KeepOutside(const BallLids& lids, std::span<glm::vec3> position) {
  for (const auto& [vertex, side, least] : lids.vertices) {
    glm::vec3& p = position[vertex];
    const glm::vec3 off = p - lids.centre[side];
    const float far = glm::length(off);
    if (far < least && far > 1) p += off * (least / far - 1);
  }
}

}  // namespace fsm
