#pragma once

#include <cstdint>
#include <vector>

#include "fsm/rig/tooth_arch.h"

namespace fsm {

/// Lips that are pushed off the teeth.
struct TeethRig {
  struct Contact {
    std::uint32_t vertex;
    float upper_gap, lower_gap;  ///< least distances from either arch, from those at rest
  };
  ToothArch upper{}, lower{};
  std::vector<Contact> contacts;
};

}  // namespace fsm
