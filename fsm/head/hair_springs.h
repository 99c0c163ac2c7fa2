#pragma once

#include <cstddef>

#include "fsm/base/table_reader.h"
#include "fsm/rig/rig_data.h"

namespace fsm {

/// Attaches the vertices of `rig.rest` from index `first` on to the springs described by
/// hair_springs.txt. Weights are interpolated between rows, and within a row between springs;
/// springs without hair are removed. Throws std::runtime_error naming file and line.
void AddHairSprings(const Table& table, std::size_t first, RigData& rig);

}  // namespace fsm
