#pragma once

#include <cstddef>
#include <vector>

#include "fsm/rig/rig_data.h"

namespace fsm {

/// What a program of shaders/rig_kernels.glsl reads of the vertices of a head: records, and entries
/// where records have lists, both structs of fsm/rig/steps.glsl as they lie in memory.
struct RigRecords {
  const char* step;       ///< the name after STEP_
  std::size_t count = 0;  ///< of records: what the program is run for
  std::vector<std::byte> records;
  std::vector<std::byte> entries;
};

/// Of all programs that move a head, in their order; those that would do nothing are left out.
std::vector<RigRecords> RecordsOfSteps(const RigData& data);

}  // namespace fsm
