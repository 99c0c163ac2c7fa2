#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "fsm/rig/tooth_arch.h"

namespace fsm {

struct Pose;

/// Lips that are held off the teeth.
struct TeethRig {
  struct Contact {
    std::uint32_t vertex;
    float upper_gap, lower_gap;  ///< least distances from either arch, by the distance at rest
  };
  ToothArch upper{}, lower{};
  std::vector<Contact> contacts;
};

/// The lower teeth are where the pose's jaw has them.
void KeepOffTeeth(const TeethRig& rig, const Pose& pose, std::span<glm::vec3> position);

}  // namespace fsm
