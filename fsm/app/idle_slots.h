#pragma once

#include "fsm/app/fsm_core.h"

namespace fsm {

/// What makes the face alive: Autonomous (each part by name), Life (a profile of them), Gaze and
/// Gaze.distance.
void DeclareIdleSlots(FsmCore& core);

}  // namespace fsm
