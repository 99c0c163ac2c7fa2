#pragma once

#include "fsm/app/fsm_core.h"

namespace fsm {

/// How lips are moved: LipSync.mode, LipSync.shapes, LipSync.names, LipSync.scale, and the mouth
/// shapes themselves (MouthShape.NAME of the 14, MouthShape28.NAME of the 28), which can be set,
/// asked, saved and loaded. All act from the next utterance on.
void DeclareLipSlots(FsmCore& core);

}  // namespace fsm
