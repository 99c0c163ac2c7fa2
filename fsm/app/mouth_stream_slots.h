#pragma once

#include "fsm/app/fsm_core.h"

namespace fsm {

/// Declares MouthFrame and MouthFrame.start: the mouth frame by frame from another program (vdm).
/// Lifetime: `core` outlives the slots.
void DeclareMouthStreamSlots(FsmCore& core);

}  // namespace fsm
