#pragma once

#include <cstddef>

#include "fsm/base/table_reader.h"
#include "fsm/rig/rig_data.h"

namespace fsm {

/// Hangs the vertices of `rig.rest` from `first` on on springs, as the table hair_springs.txt says
/// (its layout stands in its head). Rows blend into each other, and springs of a row around the
/// head; those that no hair hangs on are left out. Throws std::runtime_error naming file and line.
void AddHairSprings(const Table& table, std::size_t first, RigData& rig);

}  // namespace fsm
