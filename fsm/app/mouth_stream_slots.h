#pragma once

#include "fsm/app/fsm_core.h"

namespace fsm {

/// MouthFrame and MouthFrame.start: the mouth frame by frame from another program (vdm).
void DeclareMouthStreamSlots(FsmCore& core);

}  // namespace fsm
