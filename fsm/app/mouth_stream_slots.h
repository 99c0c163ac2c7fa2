#pragma once

#include "fsm/app/fsm_core.h"

namespace fsm {

/// Declares MouthFrame and MouthFrame.start, by which another program (vdm) moves the mouth frame
/// by frame.
void DeclareMouthStreamSlots(FsmCore& core);

}  // namespace fsm
