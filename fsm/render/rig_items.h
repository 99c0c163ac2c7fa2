#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fsm/rig/rig_data.h"

namespace fsm {

/// What a program of shaders/rig_steps.glsl reads of the vertices of a head: records of one size,
/// and behind them what is not of one size, as the shader says at each step. The structs that
/// rig_items.cc packs give the shader the sizes.
struct RigItems {
  const char* step;  ///< the name after STEP_
  std::vector<std::uint32_t> words;
  std::size_t count = 0;           ///< of records: what the program is run for
  std::uint32_t record_words = 0;  ///< RECORD in the shader
  std::uint32_t entry_words = 0;   ///< ENTRY; 0: there are no lists
};

/// Of all programs that move a head, in their order; those that would do nothing are left out.
std::vector<RigItems> ItemsOfSteps(const RigData& data);

}  // namespace fsm
