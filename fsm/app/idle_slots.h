#pragma once

#include "fsm/app/fsm_core.h"

namespace fsm {

/// Declares what makes the face alive: Autonomous (each part by name), Life (a profile of them),
/// Gaze and Gaze.distance. Lifetime: `core` outlives the slots.
void DeclareIdleSlots(FsmCore& core);

}  // namespace fsm
