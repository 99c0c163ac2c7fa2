#pragma once

#include <array>
#include <cstddef>
#include <glm/mat3x3.hpp>

namespace fsm {

/// Rotation angles of heads, eyes and figures in degrees, signed alike on the wire, in tables, in
/// motion and in states: positive is down, to the viewer's right, and tilted that way.
using Angles = std::array<float, 3>;
/// Rotation angles of an eye, which does not tilt.
using EyeAngles = std::array<float, 2>;
/// Indices into Angles and EyeAngles.
enum Axis : std::size_t { kDown, kToRight, kTilted };

/// Returns FaceState::head_rotation of a rotation: the inverse of HeadRotation (pose.h).
Angles HeadRotationOf(const glm::mat3& rotation);

}  // namespace fsm
