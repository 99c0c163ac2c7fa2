#pragma once

#include <cstddef>
#include <vector>

#include "fsm/rig/rig_data.h"

namespace fsm {

/// The vertex data that a program of shaders/rig_kernels.glsl reads: records, and entries where
/// records have lists. Both hold structs of fsm/rig/steps.glsl in their memory layout.
struct RigRecords {
  const char* step;       ///< the step's name after STEP_
  std::size_t count = 0;  ///< number of records, which is the number of invocations
  std::vector<std::byte> records;
  std::vector<std::byte> entries;
};

/// Returns the records of all programs that move a head, in order, without those that do nothing.
std::vector<RigRecords> RecordsOfSteps(const RigData& data);

}  // namespace fsm
