#pragma once

#include <cstdint>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec3.hpp>

/// Compiles steps.glsl, the arithmetic of the steps, for the processor.
namespace fsm::step {

using glm::atan, glm::clamp, glm::cos, glm::cross, glm::dot, glm::length, glm::max, glm::min,
    glm::mix, glm::normalize, glm::sin, glm::sqrt, glm::vec3;

#define FUNCTION inline
#include "fsm/rig/steps.glsl"
#undef FUNCTION

inline Rotation RotationOf(const glm::mat3& m) {
  return {PointAt(m[0]), PointAt(m[1]), PointAt(m[2])};
}

}  // namespace fsm::step
