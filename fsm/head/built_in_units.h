#pragma once

#include "fsm/rig/unit_table.h"

namespace fsm {

/// The units of tables/action_units.txt, both sides alike. Made at the first call; thread: any.
const UnitTable& BuiltInUnits();

}  // namespace fsm
