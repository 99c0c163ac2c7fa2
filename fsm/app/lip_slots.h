#pragma once

#include "fsm/app/fsm_core.h"

namespace fsm {

/// Declares the slots of lip movement: LipSync.mode, LipSync.shapes, LipSync.names, LipSync.scale,
/// and the mouth shapes (MouthShape.NAME of the 14, MouthShape28.NAME of the 28), which can be set,
/// queried, saved and loaded. Changes apply from the next utterance on.
void DeclareLipSlots(FsmCore& core);

}  // namespace fsm
