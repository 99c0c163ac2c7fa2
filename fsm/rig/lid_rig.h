#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "fsm/base/side.h"
#include "fsm/rig/eye_transform.h"

namespace fsm {

struct Pose;

/// The outer radius of the cornea, millimetres.
inline constexpr float kCorneaRadius = 8.0f;

/// Lids that turn about the axes of the eyes. Angles in radians, up from straight ahead; heights in
/// millimetres in the frame of the eye before its EyeTransform.
struct LidRig {
  struct Vertex {
    std::uint32_t vertex = 0;
    Side side{};
    float upper = 0, lower = 0;              ///< part in each lid's turn, 0..1
    float upper_angle = 0, lower_angle = 0;  ///< of the rims at rest
    float meet_angle = 0;                    ///< where the closed lids meet
    float opening = 0;    ///< how far the lids stand apart here, of the widest place
    float y = 0, z = 0;   ///< at rest from the axis of the lids
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

/// Opens, closes and bulges the lids as the pose says.
void MoveLids(const LidRig& rig, const Pose& pose, std::span<glm::vec3> position);
/// Pushes what has come into an eyeball out again.
void KeepOutside(const BallLids& lids, std::span<glm::vec3> position);

}  // namespace fsm
